// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/pressure_kind.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// How near is near, along the face: as a contact is wide, and a slice more, which finer grids count as
    /// long as the longest there are, or they would tell of places nearer to edges and kinks. [mm]
    double near(const GearPair &pair, const LineLoad &line)
    {
      constexpr double longest_slices = 31;
      return 2 * line.half_width + std::max(line.height, pair.common_face_width / longest_slices);
    }

    bool is_at_face_end(const GearPair &pair, const LineLoad &line, const double more)
    {
      return std::min(line.z - pair.face_low, pair.face_high - line.z) < near(pair, line) + more;
    }

    /// Whether an edge carries in a slice, or in another one of its tooth pair that is near.
    bool is_at_loaded_edge(const GearPair &pair, const PositionResult &position, const LineLoad &line,
                           const double more)
    {
      return std::ranges::any_of(position.lines, [&](const LineLoad &other) {
        return other.edge_pressure > 0 && other.pair == line.pair &&
               std::abs(other.z - line.z) <= near(pair, line) + more;
      });
    }
  } // namespace

  RegularPressures::RegularPressures(const ParallelAxisCase &input, const ContactGridSize &grid,
                                     const std::vector<PositionResult> &positions)
      : input_(input)
      , grid_(grid)
  {
    for (const PositionResult &position : positions)
      for (const LineLoad &line : position.lines)
        {
          half_width_ = std::max(half_width_, line.half_width);
          height_ = std::max(height_, line.height);
        }
  }

  bool RegularPressures::has_kink(const LineLoad &line, const double pitches, const double more) const
  {
    const GearPair &pair = input_.pair;
    const double along_z = near(pair, line) + more, reach = line.half_width + 2 * cell(line.half_width);
    const auto turns = [&](const Gear &gear, const FlankDeviations &flank, const double roll,
                           const double z) {
      const double by_roll =
          (reach / roll + line.height * std::tan(std::abs(gear.base_helix_angle))) / gear.base_radius +
          pitches * gear.pitch_angle();
      return std::ranges::any_of(flank.modifications, [&](const auto &modification) {
        const auto turn = modification->turn();
        return (turn.along_profile <= 2 * cell(half_width_) || turn.along_face <= 2 * height_) &&
               modification->starts_within(roll - by_roll, roll + by_roll, z - along_z, z + along_z);
      });
    };
    return turns(pair.pinion, input_.deviations.pinion, line.pinion_roll, line.z) ||
           turns(pair.gear, input_.deviations.gear,
                 pair.facing_roll(pair.gear, pair.pinion, line.pinion_roll), line.z - pair.data.axial_offset);
  }

  double RegularPressures::cell(const double half_width) const
  {
    return 2 * window_over_contact * half_width / grid_.profile_cells;
  }

  double RegularPressures::at_kinks(const std::vector<PositionResult> &positions) const
  {
    const double half_a_step = 0.5 / input_.positions;
    double greatest = 0;
    for (const PositionResult &position : positions)
      for (const LineLoad &line : position.lines)
        if (line.max_pressure > std::max(greatest, line.edge_pressure) && has_kink(line, half_a_step, 0))
          greatest = line.max_pressure;
    return greatest;
  }

  double RegularPressures::of(const PositionResult &position, const double slices) const
  {
    double greatest = 0;
    for (const LineLoad &line : position.lines)
      if (const double more = slices * line.height;
          line.max_pressure > greatest && !is_at_face_end(input_.pair, line, more) &&
          !is_at_loaded_edge(input_.pair, position, line, more) && !has_kink(line, 0, more))
        greatest = line.max_pressure;
    return greatest;
  }

  const std::vector<std::string> &pressure_kinds()
  {
    static const std::vector<std::string> names = { "regular", "kink", "edge" };
    return names;
  }

  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
  {
    // What a kink adds to the pressure beside it, which finer cells and other positions show.
    constexpr double most_of_kink = 2;
    const auto [inside, at_edges] = greatest_pressures(positions);
    const RegularPressures regular(input, input.grid, positions);
    if (inside > 0 && most_of_kink * regular.at_kinks(positions) >= inside)
      return PressureKind::kink;
    return at_edges <= inside ? PressureKind::regular : PressureKind::edge;
  }
} // namespace flank
