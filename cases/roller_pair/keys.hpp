// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"

namespace flank
{
  /// The keys of two rollers pressed together, and what `second_roller.like` copies.
  SceneKeys roller_pair_keys();
} // namespace flank
