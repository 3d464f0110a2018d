// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// The case on coarser bodies and a coarser grid, without optional outputs, over one mesh cycle.
  ParallelAxisCase coarser_case(const ParallelAxisCase &input);

  /// The first key in which coarser_case() is no coarser, because the case has the least there is: its share
  /// of the errors cannot be seen. Empty where everything is coarser.
  std::string without_coarser(const ParallelAxisCase &input);

  /// Numbers of a fifth of the positions, at least three, which are solved on coarser grids and bodies.
  std::vector<int> sampled_positions(int positions);
} // namespace flank
