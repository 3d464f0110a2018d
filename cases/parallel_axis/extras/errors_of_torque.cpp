// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/errors_of_torque.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ranges>
#include <span>

namespace flank
{
  namespace
  {
    /// How well the places are known where tooth pairs begin and end to touch, in steps between positions,
    /// over what is relatively wrong with the transmission error by its elements and cells: teeth that give
    /// way more touch earlier (validation/run coverage).
    constexpr double place_of_ends = 1.6;

    /// Share of what coarser computations of the greatest pressure differ by, found on scenes of its own
    /// (validation/run coverage).
    constexpr double of_pressure = 0.45;

    /// What cells leave of the greatest pressure, relative, where the line contact under them is not quite
    /// Hertz's: a coarser grid may differ by less than that by chance. Seen at 11, 21 and 41 cells.
    /// Beside an edge that carries more it is a matter of how near to it slices are counted.
    double of_cells(const ContactGridSize &grid, const PressureKind kind, const double certainty)
    {
      const double of_eleven = kind == PressureKind::edge ? 0.02 : 0.001 + (1 - certainty) * 0.015;
      return of_eleven * std::pow(11.0 / grid.profile_cells, 2);
    }

    /// The least certainty of the line contacts about as much pressed as the most pressed one. [MPa]
    double least_certainty(const std::span<const PositionResult> positions, const double greatest)
    {
      double least = 1;
      for (const PositionResult &position : positions)
        for (const LineLoad &line : position.lines)
          if (line.edge_pressure == 0 && line.max_pressure > 0.98 * greatest &&
              line.max_pressure <= greatest * (1 + 1e-9))
            least = std::min(least, line.certainty);
      return least;
    }

    /// How much more than the edges a position's greatest pressure must be to have a bound of its own: on
    /// finer slices an edge carries more, and slices beside it.
    constexpr double most_beside_edges = 2;

    /// Share of what coarser computations of a tooth pair's load share differ by.
    constexpr double of_share = 0.5;

    /// What no bound goes below: rounding and the differences of neighbouring grids.
    constexpr double least_of_pressure = 2e-4, least_of_share = 1e-4;

    double share_of(const PositionResult &result, const int pair)
    {
      for (const PairLoad &load : result.pairs)
        if (load.pair == pair)
          return load_share(result, load);
      return 0;
    }

    double greatest_difference_of_shares(const PositionResult &one, const PositionResult &other)
    {
      double greatest = 0;
      for (const PositionResult *result : { &one, &other })
        for (const PairLoad &load : result->pairs)
          greatest = std::max(greatest, std::abs(share_of(one, load.pair) - share_of(other, load.pair)));
      return greatest;
    }

    /// The share that a tooth pair, numbered as at position k, has some steps on (or back), where a pitch
    /// later it has the next number.
    double share_at(const std::vector<PositionResult> &positions, const int of_cycle, const int k,
                    const int pair, const int steps)
    {
      const auto n = static_cast<int>(positions.size());
      const int there = k + steps + n, pitches = there / of_cycle - (k + n) / of_cycle;
      return share_of(positions[static_cast<std::size_t>(there % n)], pair + pitches);
    }

    /// The greatest step of a tooth pair's share, from one position to the next, to its first or last one in
    /// contact or beside it: a pair begins and ends somewhere between two positions.
    double greatest_step_at_ends(const std::vector<PositionResult> &positions, const int cycles)
    {
      const auto n = static_cast<int>(positions.size()), of_cycle = n / cycles;
      double greatest = 0;
      for (int k = 0; k < n; ++k)
        for (const PairLoad &load : positions[static_cast<std::size_t>(k)].pairs)
          for (const int side : { -1, 1 })
            if (share_at(positions, of_cycle, k, load.pair, side) == 0)
              {
                const double first = load_share(positions[static_cast<std::size_t>(k)], load),
                             second = share_at(positions, of_cycle, k, load.pair, -side);
                greatest = std::max({ greatest, first, std::abs(second - first) });
              }
      return greatest;
    }

    double relative_difference(const double coarse, const double fine)
    {
      return fine > 0 ? std::abs(coarse / fine - 1) : 0;
    }

    CoarserDifferences differences_of(const ParallelAxisCase &input, const std::vector<PositionResult> &at,
                                      const std::vector<CoarserSample> &samples, const Halves &halves)
    {
      CoarserDifferences differences;
      for (const auto &[place, half] : of_transmission_error(input, at, halves))
        differences.between[place] = transmission_error_um(input.pair, half);
      for (const auto &[fine, grid, all] : samples)
        {
          const double of_grid = transmission_error_um(input.pair, grid);
          differences.by_grid.push_back(of_grid - transmission_error_um(input.pair, fine));
          differences.by_bodies.push_back(transmission_error_um(input.pair, all) - of_grid);
        }
      return differences;
    }

    /// What is wrong with the transmission error by elements and cells over its root mean square, at most 1.
    double relative_error(const std::vector<double> &te, const TransmissionErrorBounds &bounds)
    {
      double squares = 0;
      for (const double value : te)
        squares += value * value / static_cast<double>(te.size());
      const double wrong = bounds.mean_by_grid + bounds.mean_by_bodies, all = std::sqrt(squares);
      return wrong < all ? wrong / all : 1;
    }

    double load_share_error(const ParallelAxisCase &input, const std::vector<PositionResult> &at,
                            const std::vector<CoarserSample> &samples, const double of_te)
    {
      double by_grid = 0, by_bodies = 0;
      for (const auto &[fine, grid, all] : samples)
        {
          by_grid = std::max(by_grid, greatest_difference_of_shares(grid, fine));
          by_bodies = std::max(by_bodies, greatest_difference_of_shares(all, grid));
        }
      return least_of_share + of_share * (by_grid + by_bodies) +
             place_of_ends * of_te * greatest_step_at_ends(at, input.cycles);
    }

    /// The pressure of a position that is meant. [MPa]
    using PressureOf = std::function<double(const PositionResult &)>;

    /// By how much coarser grids and bodies see the greatest pressures of sampled positions otherwise.
    struct PressureDifferences
    {
      double by_grid = 0, by_bodies = 0;
      double fine = 0, coarser = 0; ///< sums of the pressures where both grids have one [MPa]
    };

    PressureDifferences differences_of(const std::vector<CoarserSample> &samples, const PressureOf &regular)
    {
      PressureDifferences found;
      for (const auto &[fine, grid, all] : samples)
        {
          found.by_grid = std::max(found.by_grid, relative_difference(regular(grid), regular(fine)));
          found.by_bodies = std::max(found.by_bodies, relative_difference(regular(all), regular(grid)));
          if (regular(fine) > 0 && regular(grid) > 0)
            found.fine += regular(fine), found.coarser += regular(grid);
        }
      return found;
    }

    /// `over_coarser`: the greatest pressure of a position over what the halves' coarser grid finds there.
    double hidden(const ParallelAxisCase &input, const std::vector<PositionResult> &at, const Halves &halves,
                  const PressureKind kind, const PressureOf &regular, const double over_coarser)
    {
      std::vector<double> pressures(at.size());
      std::ranges::transform(at, pressures.begin(), regular);
      PointsOfPeriod halfway;
      for (const auto &[place, half] : halves)
        halfway[place] = over_coarser * regular(half);
      return kind == PressureKind::regular && input.cycles == 1
                 ? hidden_pressure(pressures, halfway)
                 : hidden_between(pressures, input.positions, halfway);
    }

    /// Sets the greatest pressure that has a limit, its bound and those of the positions', where there is
    /// one.
    void set_pressure(const ParallelAxisCase &input, const std::vector<PositionResult> &at,
                      const std::vector<CoarserSample> &samples, const Halves &halves, ErrorsOfTorque &errors)
    {
      const RegularPressures away(input, at);
      const auto but = [&](const double slices) -> PressureOf {
        return [&, slices](const PositionResult &p) {
          return errors.kind == PressureKind::regular ? p.max_pressure : away.of(p, slices);
        };
      };
      const PressureOf regular = but(0);
      const double greatest = std::ranges::max(at | std::views::transform(regular)),
                   a_slice_further = std::ranges::max(at | std::views::transform(but(1)));
      if (greatest == 0)
        return;
      const PressureDifferences seen = differences_of(samples, regular);
      const auto of_coarser = [&](const double certainty) {
        return least_of_pressure + std::max(of_pressure * (seen.by_grid + seen.by_bodies),
                                            of_cells(input.grid, errors.kind, certainty));
      };
      const auto is_regular = [&](const PositionResult &p) {
        return p.max_pressure > most_beside_edges * away.at_edges(p) &&
               away.kind_of({ &p, 1 }) == PressureKind::regular && away.of(p, 1) == p.max_pressure;
      };
      errors.regular_pressure = greatest;
      errors.pressure =
          of_coarser(least_certainty(at, greatest)) + relative_difference(a_slice_further, greatest) +
          hidden(input, at, halves, errors.kind, regular, seen.coarser > 0 ? seen.fine / seen.coarser : 1);
      for (const PositionResult &p : at)
        errors.pressure_at.push_back(is_regular(p)
                                         ? greatest * of_coarser(least_certainty({ &p, 1 }, p.max_pressure))
                                         : ErrorsOfTorque::unknown);
    }
  } // namespace

  ErrorsOfTorque errors_of_torque(const ParallelAxisCase &input, const std::vector<PositionResult> &at,
                                  const std::vector<CoarserSample> &samples, const Halves &halves)
  {
    const std::vector<double> te = errors_over_cycle(input.pair, at);
    ErrorsOfTorque errors{ .kind = pressure_kind_with(input, at, halves) };
    errors.te = error_bounds(te, harmonics(te), input.cycles, differences_of(input, at, samples, halves));
    if (at.front().torque > 0)
      errors.load_share = load_share_error(input, at, samples, relative_error(te, errors.te));
    set_pressure(input, at, samples, halves, errors);
    return errors;
  }
} // namespace flank
