// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"

#include <vector>

namespace flank
{
  /// The case on coarser bodies and a coarser grid, without optional outputs, over one mesh cycle.
  ParallelAxisCase coarser_case(const ParallelAxisCase &input);

  /// Whether coarser_case() is coarser in everything: flank elements of both bodies, slices, cells.
  bool has_coarser(const ParallelAxisCase &input);

  /// Numbers of a quarter of the positions, at least three, which are solved on coarser grids and bodies.
  std::vector<int> sampled_positions(int positions);
} // namespace flank
