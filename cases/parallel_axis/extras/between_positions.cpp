// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/between_positions.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/error_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace flank
{
  namespace
  {
    constexpr double of_half_as_many = 0.375; ///< of the greatest value that half the positions miss

    /// Of what curves along lines reach beyond the greatest of the positions (validation/run coverage).
    constexpr double of_lines = 0.45;

    /// Pressure may fall abruptly as soon as it falls nine tenths as steeply as it rose, where the next tooth
    /// pair takes its load (validation/run coverage).
    constexpr double jump_of_pressure = 0.9;

    /// Of what it may reach beyond what is seen (validation/run coverage).
    constexpr double of_reach = 0.9;

    /// Into how many steps at most is looked for a greater pressure, where it may be greater by this at
    /// least, relative.
    constexpr std::size_t most_looks = 2;
    constexpr double least_looked_for = 2e-4;

    std::size_t number_of_greatest(const std::vector<double> &values)
    {
      return static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
    }

    /// How much more than the greatest of the positions may hide between them, relative: as much again as
    /// halfway is seen.
    double seen_halfway(const std::vector<double> &values, const PointsOfPeriod &halves)
    {
      const double greatest = values[number_of_greatest(values)];
      double seen = greatest;
      for (const auto &[place, value] : halves)
        seen = std::max(seen, value);
      return greatest > 0 ? 2 * (seen / greatest - 1) : 0;
    }

    /// The same where nothing is seen halfway: three eighths of what half as many positions of a mesh cycle
    /// miss.
    double missed_by_half_as_many(const std::vector<double> &values, const int of_cycle)
    {
      double of_half[2] = { 0, 0 };
      for (std::size_t k = 0; k < values.size(); ++k)
        {
          double &greatest = of_half[k % static_cast<std::size_t>(of_cycle) % 2];
          greatest = std::max(greatest, values[k]);
        }
      const auto [less, most] = std::minmax(of_half[0], of_half[1]);
      return most > 0 ? of_half_as_many * (1 - less / most) : 0;
    }

    /// Whether both places halfway beside the greatest of the positions were computed.
    bool is_seen_beside_greatest(const std::vector<double> &values, const PointsOfPeriod &halves)
    {
      const auto n = static_cast<double>(values.size()), at = static_cast<double>(number_of_greatest(values));
      return halves.contains(at + 0.5) && halves.contains(at > 0 ? at - 0.5 : n - 0.5);
    }

    /// How much more than the greatest of the positions a curve may reach beside it that bends one way from
    /// each of the known places to the next, relative. Both places halfway are known.
    double hidden_along_lines(const std::vector<double> &values, const PointsOfPeriod &halves)
    {
      const auto n = static_cast<int>(values.size()), most = static_cast<int>(number_of_greatest(values));
      std::vector<std::pair<double, double>> points;
      for (const double from : { -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0 })
        {
          const double place = std::fmod(most + from + n, n);
          const auto half = halves.find(place);
          const double value = half != halves.end() ? half->second : values[static_cast<std::size_t>(place)];
          if (value == 0)
            return 0; // nothing of the kind that is meant, there
          points.emplace_back(from, value);
        }
      const double greatest = values[static_cast<std::size_t>(most)];
      return of_lines * std::max(0.0, greatest_between(points, 1) / greatest - 1);
    }

    /// The steps that a greater pressure may hide in, of the greatest reach.
    std::vector<int> steps_of_hidden_pressure(const std::vector<double> &pressures)
    {
      const auto n = static_cast<int>(pressures.size());
      const double least = (1 + least_looked_for) * pressures[number_of_greatest(pressures)];
      std::vector<std::pair<double, int>> reaches;
      for (int k = 0; k < n; ++k)
        {
          std::vector<std::pair<double, double>> points;
          for (const int from : { -1, 0, 1, 2 })
            points.emplace_back(from, pressures[static_cast<std::size_t>((k + from + n) % n)]);
          if (const double reach = greatest_between(points, 1, jump_of_pressure); reach > least)
            reaches.emplace_back(-reach, k);
        }
      std::ranges::sort(reaches);
      std::vector<int> steps;
      for (const auto &[reach, step] : reaches)
        if (steps.size() < most_looks)
          steps.push_back(step);
      return steps;
    }

    auto by_transmission_error(const ParallelAxisCase &input)
    {
      return [&input](const PositionResult &a, const PositionResult &b) {
        return transmission_error_um(input.pair, a) < transmission_error_um(input.pair, b);
      };
    }
  } // namespace

  std::vector<int> peaks_of_transmission_error(const ParallelAxisCase &input,
                                               const std::vector<PositionResult> &positions)
  {
    const auto [least, greatest] = std::ranges::minmax_element(positions, by_transmission_error(input));
    return { static_cast<int>(least - positions.begin()), static_cast<int>(greatest - positions.begin()) };
  }

  std::vector<int> halves_of_contact(const ParallelAxisCase &input,
                                     const std::vector<PositionResult> &positions)
  {
    std::vector<int> places, steps = steps_of_jumps(errors_over_cycle(input.pair, positions));
    if (positions.front().torque > 0 && pressure_kind(input, positions) == PressureKind::regular)
      {
        std::vector<double> pressures;
        for (const PositionResult &position : positions)
          pressures.push_back(position.max_pressure);
        std::ranges::copy(steps_of_hidden_pressure(pressures), std::back_inserter(steps));
      }
    for (const int peak : peaks_of_transmission_error(input, positions))
      places.insert(places.end(), { 2 * peak - 1, 2 * peak + 1 });
    for (const int step : steps)
      places.push_back(2 * step + 1);
    return places;
  }

  Halves of_transmission_error(const ParallelAxisCase &input, const std::vector<PositionResult> &positions,
                               const Halves &halves)
  {
    Halves found = beside(peaks_of_transmission_error(input, positions), halves, positions.size());
    for (const int step : steps_of_jumps(errors_over_cycle(input.pair, positions)))
      if (const auto half = halves.find(step + 0.5); half != halves.end())
        found.insert(*half);
    return found;
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

  double hidden_between(const std::vector<double> &values, const int of_cycle, const PointsOfPeriod &halves)
  {
    const double of_halves = seen_halfway(values, halves);
    if (!is_seen_beside_greatest(values, halves))
      return std::max(of_halves, missed_by_half_as_many(values, of_cycle));
    return values.size() > 2 ? std::max(of_halves, hidden_along_lines(values, halves)) : of_halves;
  }

  double hidden_pressure(const std::vector<double> &pressures, const PointsOfPeriod &halves)
  {
    PointsOfPeriod known = halves;
    for (std::size_t k = 0; k < pressures.size(); ++k)
      known[static_cast<double>(k)] = pressures[k];
    if (known.size() < 3)
      return 0;
    const double greatest = pressures[number_of_greatest(pressures)],
                 seen = std::ranges::max_element(known, {}, &PointsOfPeriod::value_type::second)->second,
                 reach = greatest_between(known, static_cast<double>(pressures.size()), 1, jump_of_pressure);
    return (seen + of_reach * (reach - seen)) / greatest - 1;
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
