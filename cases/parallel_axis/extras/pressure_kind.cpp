// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/pressure_kind.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include <algorithm>

namespace flank
{
  namespace
  {
    /// Whether either flank turns within less than two cells, which then see a kink, where a slice carries or
    /// two cells beside.
    bool has_kink(const ParallelAxisCase &input, const LineLoad &line)
    {
      const GearPair &pair = input.pair;
      const double cell = 2 * window_over_contact * line.half_width / input.grid.profile_cells,
                   reach = line.half_width + 2 * cell;
      const auto turns = [&](const Gear &gear, const FlankDeviations &flank, const double roll,
                             const double z) {
        const double by_roll = reach / (gear.base_radius * roll);
        return std::ranges::any_of(flank.modifications, [&](const auto &modification) {
          const auto turn = modification->turn();
          return (turn.along_profile <= 2 * cell || turn.along_face <= 2 * line.height) &&
                 modification->starts_within(roll - by_roll, roll + by_roll, z - line.height,
                                             z + line.height);
        });
      };
      return turns(pair.pinion, input.deviations.pinion, line.pinion_roll, line.z) ||
             turns(pair.gear, input.deviations.gear,
                   pair.facing_roll(pair.gear, pair.pinion, line.pinion_roll),
                   line.z - pair.data.axial_offset);
    }

    /// Whether an edge carries in a slice, or a face end is nearer than the contact is wide.
    bool is_at_edge(const GearPair &pair, const LineLoad &line)
    {
      return line.edge_pressure > 0 || std::min(line.z - pair.face_low, pair.face_high - line.z) <
                                           2 * line.half_width + line.height / 2;
    }

    /// Greatest pressure inside the flanks of the slices that have a kink. [MPa]
    double pressure_at_kinks(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
    {
      double greatest = 0;
      for (const PositionResult &position : positions)
        for (const LineLoad &line : position.lines)
          if (line.max_pressure > std::max(greatest, line.edge_pressure) && has_kink(input, line))
            greatest = line.max_pressure;
      return greatest;
    }
  } // namespace

  const std::vector<std::string> &pressure_kinds()
  {
    static const std::vector<std::string> names = { "regular", "kink", "edge" };
    return names;
  }

  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
  {
    constexpr double rounding = 1e-12;
    const auto [inside, at_edges] = greatest_pressures(positions);
    if (inside > 0 && pressure_at_kinks(input, positions) >= (1 - rounding) * inside)
      return PressureKind::kink;
    return at_edges <= inside ? PressureKind::regular : PressureKind::edge;
  }

  double regular_pressure(const ParallelAxisCase &input, const PositionResult &position)
  {
    double greatest = 0;
    for (const LineLoad &line : position.lines)
      if (line.max_pressure > greatest && !is_at_edge(input.pair, line) && !has_kink(input, line))
        greatest = line.max_pressure;
    return greatest;
  }
} // namespace flank
