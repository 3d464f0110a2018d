// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/operator_image.hpp"

namespace flank::fuzz
{
  /// An operator that take_operator() takes, of a body of four elements: laid out as a real one, its numbers
  /// made up.
  std::vector<char> small_operator(Split split);
} // namespace flank::fuzz
