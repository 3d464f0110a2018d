// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/pressure_kind.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Whether a face end is that near to a slice. [mm]
    bool is_at_face_end(const GearPair &pair, const LineLoad &line, const double near)
    {
      return std::min(line.z - pair.face_low, pair.face_high - line.z) < near;
    }

    /// Whether an edge carries in a slice, or in another one of its tooth pair that is that near. [mm]
    bool is_at_loaded_edge(const PositionResult &position, const LineLoad &line, const double near)
    {
      return std::ranges::any_of(position.lines, [&](const LineLoad &other) {
        return other.edge_pressure > 0 && other.pair == line.pair && std::abs(other.z - line.z) <= near;
      });
    }
  } // namespace

  RegularPressures::RegularPressures(const ParallelAxisCase &input,
                                     const std::vector<PositionResult> &positions)
      : input_(input)
      , slice_(input.pair.common_face_width / std::min(most_slices, coarser(input.grid).slices))
  {
    for (const PositionResult &position : positions)
      for (const LineLoad &line : position.lines)
        {
          half_width_ = std::max(half_width_, line.half_width);
          height_ = std::max(height_, line.height);
        }
  }

  bool RegularPressures::has_kink(const LineLoad &line, const double pitches, const double slices) const
  {
    const GearPair &pair = input_.pair;
    const auto cell = [](const ContactGridSize &grid, const double half_width) {
      return 2 * window_over_contact * half_width / grid.profile_cells;
    };
    const double two_cells = 2 * cell(input_.grid, half_width_),
                 across = line.half_width + 2 * cell(coarser(input_.grid), line.half_width),
                 along = near(line, slices);
    const auto turns = [&](const Gear &gear, const FlankDeviations &flank, const double roll,
                           const double z) {
      // Over a slice the contact line itself runs across the profile.
      const double by_roll =
          (across / roll + slice_ * std::tan(std::abs(gear.base_helix_angle))) / gear.base_radius +
          pitches * gear.pitch_angle();
      return std::ranges::any_of(flank.modifications, [&](const auto &modification) {
        const auto turn = modification->turn();
        return (turn.along_profile <= two_cells || turn.along_face <= 2 * height_) &&
               modification->starts_within(roll - by_roll, roll + by_roll, z - along, z + along);
      });
    };
    return turns(pair.pinion, input_.deviations.pinion, line.pinion_roll, line.z) ||
           turns(pair.gear, input_.deviations.gear,
                 pair.facing_roll(pair.gear, pair.pinion, line.pinion_roll), line.z - pair.data.axial_offset);
  }

  double RegularPressures::near(const LineLoad &line, const double slices) const
  {
    return 2 * line.half_width + (1 + slices) * slice_;
  }

  double RegularPressures::at_kinks(const std::span<const PositionResult> positions) const
  {
    const double half_a_step = 0.5 / input_.positions;
    double greatest = 0;
    for (const PositionResult &position : positions)
      for (const LineLoad &line : position.lines)
        if (line.max_pressure > std::max(greatest, line.edge_pressure) && has_kink(line, half_a_step, 0))
          greatest = line.max_pressure;
    return greatest;
  }

  double RegularPressures::at_edges(const PositionResult &position) const
  {
    double greatest = position.edge_pressure;
    for (const LineLoad &line : position.lines)
      if (is_at_face_end(input_.pair, line, 0.75 * line.height))
        greatest = std::max(greatest, line.max_pressure);
    return greatest;
  }

  double RegularPressures::of(const PositionResult &position, const double slices) const
  {
    double greatest = 0;
    for (const LineLoad &line : position.lines)
      if (const double beside = near(line, slices);
          line.max_pressure > greatest && !is_at_face_end(input_.pair, line, beside) &&
          !is_at_loaded_edge(position, line, beside) && !has_kink(line, 0, slices))
        greatest = line.max_pressure;
    return greatest;
  }

  PressureKind RegularPressures::kind_of(const std::span<const PositionResult> positions) const
  {
    // A kink may double the pressure, on finer cells or between the positions.
    constexpr double most_of_kink = 2;
    const auto [inside, at_edges] = greatest_pressures(positions);
    if (inside > 0 && most_of_kink * at_kinks(positions) >= inside)
      return PressureKind::kink;
    return at_edges <= inside ? PressureKind::regular : PressureKind::edge;
  }

  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
  {
    return RegularPressures(input, positions).kind_of(positions);
  }

  std::vector<std::vector<PressureKind>> pressure_kinds_of(const ParallelAxisCase &input,
                                                           const std::vector<std::vector<PositionResult>> &at)
  {
    std::vector<std::vector<PressureKind>> kinds;
    for (const std::vector<PositionResult> &positions : at)
      {
        const RegularPressures pressures(input, positions);
        std::vector<PressureKind> &of_torque = kinds.emplace_back();
        for (const PositionResult &position : positions)
          of_torque.push_back(pressures.kind_of({ &position, 1 }));
      }
    return kinds;
  }
} // namespace flank
