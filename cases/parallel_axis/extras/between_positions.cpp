// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/between_positions.hpp"

#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/extras/root_stress_error.hpp"
#include "cases/parallel_axis/pair/between_points.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr double of_half_as_many = 0.375; ///< of the greatest value that half the positions miss

    /// Of what curves along lines reach beyond the greatest of the positions (validation/run coverage: 0.4 of
    /// it was seen).
    constexpr double of_lines = 0.45;

    double pressure_of(const PositionResult &position)
    {
      return position.max_pressure;
    }

    template <class Value>
    auto by(const Value &value)
    {
      return [&value](const PositionResult &a, const PositionResult &b) { return value(a) < value(b); };
    }

    template <class Value>
    std::size_t number_of_greatest(const std::vector<PositionResult> &positions, const Value &value)
    {
      return static_cast<std::size_t>(std::ranges::max_element(positions, by(value)) - positions.begin());
    }

    /// How much more than the greatest of the positions may hide between them, relative: as much again as
    /// halfway is seen.
    template <class Value>
    double hidden(const std::vector<PositionResult> &positions, const Halves &halves, const Value &value,
                  const double over_coarser)
    {
      const double greatest = value(positions[number_of_greatest(positions, value)]);
      double seen = greatest;
      for (const auto &[place, half] : halves)
        seen = std::max(seen, over_coarser * value(half));
      return greatest > 0 ? 2 * (seen / greatest - 1) : 0;
    }

    /// The same where nothing is seen halfway: three eighths of what half as many positions of a mesh cycle
    /// miss.
    template <class Value>
    double missed_by_half_as_many(const std::vector<PositionResult> &positions, const int of_cycle,
                                  const Value &value)
    {
      double of_half[2] = { 0, 0 };
      for (std::size_t k = 0; k < positions.size(); ++k)
        {
          double &greatest = of_half[k % static_cast<std::size_t>(of_cycle) % 2];
          greatest = std::max(greatest, value(positions[k]));
        }
      const auto [less, most] = std::minmax(of_half[0], of_half[1]);
      return most > 0 ? of_half_as_many * (1 - less / most) : 0;
    }

    /// Whether both places halfway beside the greatest of the positions were computed.
    template <class Value>
    bool is_seen_beside_greatest(const std::vector<PositionResult> &positions, const Halves &halves,
                                 const Value &value)
    {
      const auto n = static_cast<double>(positions.size()),
                 at = static_cast<double>(number_of_greatest(positions, value));
      return halves.contains(at + 0.5) && halves.contains(at > 0 ? at - 0.5 : n - 0.5);
    }

    /// How much more than the greatest of the positions a curve may reach beside it that bends one way from
    /// each of the known places to the next, relative. Both places halfway are known.
    double hidden_along_lines(const std::vector<PositionResult> &positions, const Halves &halves,
                              const PressureOf &pressure, const double over_coarser)
    {
      const auto n = static_cast<int>(positions.size()),
                 most = static_cast<int>(number_of_greatest(positions, pressure));
      std::vector<std::pair<double, double>> points;
      for (const double from : { -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0 })
        {
          const double place = std::fmod(most + from + n, n);
          const auto half = halves.find(place);
          const double value = half != halves.end() ? over_coarser * pressure(half->second)
                                                    : pressure(positions[static_cast<std::size_t>(place)]);
          if (value == 0)
            return 0; // nothing of the kind that is meant, there
          points.emplace_back(from, value);
        }
      const double greatest = pressure(positions[static_cast<std::size_t>(most)]);
      return of_lines * std::max(0.0, greatest_between(points, 1) / greatest - 1);
    }

    /// What hides, by halves where they stand beside the greatest of the positions.
    template <class Value>
    double hidden_or_missed(const std::vector<PositionResult> &positions, const int of_cycle,
                            const Halves &halves, const Value &value, const double over_coarser)
    {
      const double of_halves = hidden(positions, halves, value, over_coarser);
      return is_seen_beside_greatest(positions, halves, value)
                 ? of_halves
                 : std::max(of_halves, missed_by_half_as_many(positions, of_cycle, value));
    }
  } // namespace

  bool asks_for_root_stress(const ParallelAxisCase &input)
  {
    return std::ranges::any_of(input.extras,
                               [](const auto &extra) { return extra->name() == root_stress_name; });
  }

  std::vector<int> peaks_of_transmission_error(const ParallelAxisCase &input,
                                               const std::vector<PositionResult> &positions)
  {
    const auto te = [&](const PositionResult &p) { return transmission_error_um(input.pair, p); };
    const auto [least, greatest] = std::ranges::minmax_element(positions, by(te));
    return { static_cast<int>(least - positions.begin()), static_cast<int>(greatest - positions.begin()) };
  }

  std::vector<int> peaks_of_contact(const ParallelAxisCase &input,
                                    const std::vector<PositionResult> &positions)
  {
    std::vector<int> peaks = peaks_of_transmission_error(input, positions);
    if (positions.front().torque > 0 && pressure_kind(input, positions) == PressureKind::regular)
      peaks.push_back(static_cast<int>(number_of_greatest(positions, pressure_of)));
    return peaks;
  }

  std::vector<int> peaks_of(const FinishedRun &run, const std::size_t torque)
  {
    const std::vector<PositionResult> &at = run.at[torque];
    std::vector<int> peaks = peaks_of_contact(run.input, at);
    if (run.input.torques[torque] > 0 && asks_for_root_stress(run.input))
      for (const Side side : { Side::pinion, Side::gear })
        {
          const auto bending = [&](const PositionResult &p) {
            return greatest_bending(run.input.pair, p, side);
          };
          peaks.push_back(static_cast<int>(number_of_greatest(at, bending)));
        }
    return peaks;
  }

  Halves beside(const std::vector<int> &peaks, const Halves &halves, const std::size_t positions)
  {
    const auto n = static_cast<double>(positions);
    Halves found;
    for (const int peak : peaks)
      for (const double place : { peak + 0.5, peak > 0 ? peak - 0.5 : n - 0.5 })
        if (const auto half = halves.find(place); half != halves.end())
          found.insert(*half);
    return found;
  }

  double hidden_pressure(const std::vector<PositionResult> &positions, const int of_cycle,
                         const Halves &halves, const double over_coarser, const PressureOf &pressure)
  {
    const double hidden = hidden_or_missed(positions, of_cycle, halves, pressure, over_coarser);
    return positions.size() > 2 && is_seen_beside_greatest(positions, halves, pressure)
               ? std::max(hidden, hidden_along_lines(positions, halves, pressure, over_coarser))
               : hidden;
  }

  double hidden_root_stress(const GearPair &pair, const std::vector<PositionResult> &positions,
                            const int of_cycle, const Halves &halves, const Side side)
  {
    const auto bending = [&](const PositionResult &p) { return greatest_bending(pair, p, side); };
    return hidden_or_missed(positions, of_cycle, halves, bending, 1);
  }

  PressureKind pressure_kind_with(const ParallelAxisCase &input, const std::vector<PositionResult> &positions,
                                  const Halves &halves)
  {
    const PressureKind kind = pressure_kind(input, positions);
    double inside = greatest_pressures(positions).inside, at_edges = 0;
    for (const auto &[place, half] : halves)
      {
        inside = std::max(inside, half.max_pressure);
        at_edges = std::max(at_edges, half.edge_pressure);
      }
    return kind == PressureKind::regular && at_edges > inside ? PressureKind::edge : kind;
  }
} // namespace flank
