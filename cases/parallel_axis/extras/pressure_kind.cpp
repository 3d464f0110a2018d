// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/pressure_kind.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include <algorithm>

namespace flank
{
  namespace
  {
    /// Whether a loaded flank turns within less than two cells, which then see a kink.
    bool turns_within_cells(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
    {
      double half_width = 0, height = 0;
      for (const PositionResult &p : positions)
        for (const LineLoad &line : p.lines)
          {
            half_width = std::max(half_width, line.half_width);
            height = std::max(height, line.height);
          }
      const double cell = 2 * window_over_contact * half_width / input.grid.profile_cells;
      for (const FlankDeviations *flank : { &input.deviations.pinion, &input.deviations.gear })
        for (const auto &modification : flank->modifications)
          if (const auto turn = modification->turn();
              turn.along_profile <= 2 * cell || turn.along_face <= 2 * height)
            return true;
      return false;
    }
  } // namespace

  const std::vector<std::string> &pressure_kinds()
  {
    static const std::vector<std::string> names = { "regular", "kink", "edge" };
    return names;
  }

  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
  {
    if (positions.front().torque > 0 && turns_within_cells(input, positions))
      return PressureKind::kink;
    const auto [inside, at_edges] = greatest_pressures(positions);
    return at_edges <= inside ? PressureKind::regular : PressureKind::edge;
  }
} // namespace flank
