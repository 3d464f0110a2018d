// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/coarser_case.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  ParallelAxisCase coarser_case(const ParallelAxisCase &input)
  {
    constexpr int fewest_points = 3;
    ParallelAxisCase coarse = input;
    coarse.pinion_mesh = coarser(input.pinion_mesh);
    coarse.gear_mesh = coarser(input.gear_mesh);
    coarse.near_field.points = std::max(fewest_points, input.near_field.points - 1);
    coarse.grid = coarser(input.grid);
    coarse.cycles = 1;
    coarse.extras.clear();
    return coarse;
  }

  bool has_coarser(const ParallelAxisCase &input)
  {
    const ParallelAxisCase coarse = coarser_case(input);
    return coarse.pinion_mesh.flank_rows < input.pinion_mesh.flank_rows &&
           coarse.gear_mesh.flank_rows < input.gear_mesh.flank_rows &&
           coarse.grid.slices < input.grid.slices && coarse.grid.profile_cells < input.grid.profile_cells;
  }

  std::vector<int> sampled_positions(const int positions)
  {
    const int count = std::min(positions, std::max(3, positions / 4));
    std::vector<int> sampled;
    for (int k = 0; k < count; ++k)
      sampled.push_back(static_cast<int>(std::lround(1.0 * k * positions / count)));
    return sampled;
  }
} // namespace flank
