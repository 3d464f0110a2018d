// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/solved_contact.hpp"

#include <algorithm>

namespace flank
{
  std::map<int, PositionResult> solved_contact(const ParallelAxisCase &input, const LoadedPair &mesh,
                                               const int position, const std::vector<int> &torques)
  {
    std::map<int, PositionResult> result;
    for (const auto &band : torque_bands(input.torques, input.grid.profile_cells))
      {
        const auto wanted = [&](const int t) {
          return std::find(torques.begin(), torques.end(), t) != torques.end();
        };
        if (std::none_of(band.begin(), band.end(), wanted))
          continue;
        std::vector<double> of_band;
        for (const int t : band)
          of_band.push_back(input.torques[t]);
        auto solved = mesh.solve(1.0 * position / input.positions, of_band);
        for (std::size_t i = 0; i < band.size(); ++i)
          if (wanted(band[i]))
            result.emplace(band[i], std::move(solved[i]));
      }
    return result;
  }

  LoadedPair mesh_with_cells(const ParallelAxisCase                                   &input,
                             const std::vector<std::shared_ptr<const BodyCompliance>> &bodies)
  {
    LoadedPair mesh{ { input.pair, *bodies.front(), *bodies.back(), input.grid, input.pinion_mounting,
                       input.gear_mounting },
                     input.deviations };
    mesh.keep_cells = true;
    return mesh;
  }
} // namespace flank
