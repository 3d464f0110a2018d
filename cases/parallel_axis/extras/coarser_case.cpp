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
    coarse.near_field.points = std::max(fewest_points, input.near_field.points - 2);
    coarse.grid = coarser(input.grid);
    coarse.cycles = 1;
    coarse.extras.clear();
    return coarse;
  }

  std::string without_coarser(const ParallelAxisCase &input)
  {
    const ParallelAxisCase coarse = coarser_case(input);
    struct Count
    {
      const char *key;
      int SectorResolution::*of_body;
    };
    for (const Count &count : { Count{ "mesh.flank_rows", &SectorResolution::flank_rows },
                                { "mesh.tooth_columns", &SectorResolution::tooth_columns },
                                { "mesh.face_layers", &SectorResolution::face_layers },
                                { "mesh.fillet_rows", &SectorResolution::fillet_rows },
                                { "mesh.fillet_columns", &SectorResolution::fillet_columns },
                                { "mesh.rim_layers", &SectorResolution::rim_layers } })
      if (!(coarse.pinion_mesh.*count.of_body < input.pinion_mesh.*count.of_body) ||
          !(coarse.gear_mesh.*count.of_body < input.gear_mesh.*count.of_body))
        return count.key;
    if (input.near_field.split == Split::projected && !(coarse.near_field.points < input.near_field.points))
      return "contact.near_field_points";
    if (!(coarse.grid.slices < input.grid.slices))
      return "contact_grid.slices";
    return coarse.grid.profile_cells < input.grid.profile_cells ? "" : "contact_grid.profile_cells";
  }

  std::vector<int> sampled_positions(const int positions)
  {
    const int count = std::min(positions, std::max(3, positions / 5));
    std::vector<int> sampled;
    for (int k = 0; k < count; ++k)
      sampled.push_back(static_cast<int>(std::lround(1.0 * k * positions / count)));
    return sampled;
  }
} // namespace flank
