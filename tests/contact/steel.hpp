// SPDX-License-Identifier: GPL-2.0-or-later
// The material of the tests of half-spaces.
#pragma once

#include "mesh/base/units.hpp"

namespace flank
{
  inline constexpr double E = 2.1e5, nu = 0.3; // MPa, -
  using units::pi;
} // namespace flank
