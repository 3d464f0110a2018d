// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/error_bounds.hpp"

#include "cases/parallel_axis/pair/between_points.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/results/harmonics.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace flank
{
  namespace
  {
    /// Shares of what coarser computations differ by, found on scenes of their own (validation/run coverage).
    constexpr double of_mean = 0.45;   ///< of the differences' mean, in the mean of all positions
    constexpr double of_scatter = 0.3; ///< of the differences about it, there
    constexpr std::array of_deviation = { 0.15, 0.05,
                                          0.03 }; ///< of the differences, in a harmonic: they are smooth
    /// Of what the spectrum's upper half, as it falls on, folds into the mean and the harmonics: where what
    /// lies halfway in the steps of the greatest jumps is known, or there are none, and where it is not.
    constexpr std::array of_folded = { 0.45, 0.2, 0.3, 0.4 }, of_folded_alone = { 0.45, 0.45, 0.4, 0.55 };
    constexpr int halved_steps = 2;     ///< so many jumps are looked into
    constexpr double least_jump = 0.02; ///< of peak-to-peak, that is
    constexpr double of_step = 0.6;     ///< of a step: how wide what stands out in it is taken, as most are
    constexpr double of_place = 0.6; ///< of what a jump makes of a harmonic half a step away from its place
    constexpr double of_mean_by_jumps =
        0.7; ///< of that, in the mean: one jump moves it half as much, and two add up
    constexpr double of_position = 1.2;   ///< of the differences about their mean, in a position
    constexpr double of_peak_to_peak = 1; ///< of the differences about their mean, in peak-to-peak
    constexpr double of_hidden = 0.85;    ///< of how far a curve can go between positions, in peak-to-peak
    constexpr double least_share = 2e-4;  ///< of the mean: what no estimate goes below
    constexpr double least_of_first = 1.35e-4; ///< of the mean: what slices and cells at kinks leave of A1

    /// Fewer positions of a mesh cycle than enough_positions do not show how fast the spectrum falls. Then no
    /// less is stated than these shares of peak-to-peak over their number, below very_few positions twice as
    /// much, and below fewest_positions only the mean's parts by bodies and grid (validation/run coverage
    /// --few). How far a curve can go between few positions counts by three quarters more: it may bend both
    /// ways from one to the next.
    constexpr double mean_of_few = 0.6, amplitude_of_few = 1, peak_to_peak_of_few = 0.8, hidden_by_few = 1.75;
    constexpr int enough_positions = 16, very_few = 6;

    /// The mesh harmonics of a transmission error fall as this power of their number, where tooth pairs come
    /// into contact and leave it (validation/run coverage).
    constexpr double fall_of_harmonics = 1.5;

    /// What folds into mesh harmonic `harmonic` (0: into the mean) at `positions` a mesh cycle: the harmonics
    /// in the upper half of the spectrum that they show, carried on to the one that looks like it. [um]
    double folded(const std::vector<Harmonic> &spectrum, const int cycles, const int positions,
                  const int harmonic, const std::array<double, 4> &shares)
    {
      const int last = positions / 2, first = std::min(last, std::max(harmonic + 1, last / 2));
      double squares = 0;
      for (int i = first; i <= last; ++i)
        {
          const double fallen = std::pow(1.0 * i / (positions - harmonic), fall_of_harmonics),
                       amplitude = spectrum[static_cast<std::size_t>(i * cycles - 1)].amplitude;
          squares += fallen * fallen * amplitude * amplitude;
        }
      return shares[static_cast<std::size_t>(harmonic)] * std::sqrt(squares);
    }

    struct Scatter
    {
      double mean = 0, deviation = 0;
    };

    Scatter scatter(const std::vector<double> &values)
    {
      const auto n = static_cast<double>(values.size());
      Scatter result;
      result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
      for (const double value : values)
        result.deviation += (value - result.mean) * (value - result.mean) / std::max(1.0, n - 1);
      result.deviation = std::sqrt(result.deviation);
      return result;
    }

    /// Peak-to-peak of every other value: the lesser one of those with even and those with odd numbers.
    double peak_to_peak_of_half(const std::vector<double> &values)
    {
      std::vector<double> of[2];
      for (std::size_t k = 0; k < values.size(); ++k)
        of[k % 2].push_back(values[k]);
      return of[1].empty() ? 0 : std::min(peak_to_peak(of[0]), peak_to_peak(of[1]));
    }

    /// Whether what lies halfway on both sides of the least and the greatest value is known.
    bool is_known_beside_peaks(const std::vector<double> &te, const CoarserDifferences &coarser)
    {
      const auto [least, greatest] = std::minmax_element(te.begin(), te.end());
      const auto n = static_cast<double>(te.size());
      for (const auto peak : { least, greatest })
        {
          const auto at = static_cast<double>(peak - te.begin());
          if (!coarser.between.contains(at + 0.5) || !coarser.between.contains(at > 0 ? at - 0.5 : n - 0.5))
            return false;
        }
      return true;
    }

    /// How much peak-to-peak may grow with ever more positions: as far as a curve can go that bends one way
    /// between what is known, and as far again as what lies halfway has seen, which is what a kink does;
    /// where that is not known beside the least or the greatest value, half of what half as many positions
    /// miss.
    double hidden_peaks(const std::vector<double> &te, const CoarserDifferences &coarser,
                        const double by_grid)
    {
      PointsOfPeriod points;
      for (std::size_t k = 0; k < te.size(); ++k)
        points[static_cast<double>(k)] = te[k];
      const double all = peak_to_peak(te);
      double low = *std::min_element(te.begin(), te.end()), high = low + all;
      for (const auto &[place, value] : coarser.between)
        {
          points[place] = value - by_grid;
          low = std::min(low, points[place]);
          high = std::max(high, points[place]);
        }
      const auto period = static_cast<double>(te.size());
      const double reach = std::max(high, greatest_between(points, period, 1)) +
                           std::max(-low, greatest_between(points, period, -1));
      const double of_halves = coarser.between.empty() ? 0 : 2 * (high - low - all);
      const double of_fewer = is_known_beside_peaks(te, coarser) ? 0 : (all - peak_to_peak_of_half(te)) / 2;
      return std::max({ reach - all, of_halves, of_fewer });
    }

    /// By how much a step rises or falls more than those beside it, with the sign of its way, counted as far
    /// as that is all of the step: a curve that rises over two steps is known better. [um]
    double jump_of(const double rise, const double before, const double after)
    {
      const double way = rise < 0 ? -1 : 1, height = way * rise,
                   jump = height - std::max({ 0.0, way * before, way * after });
      return jump > 0 ? way * jump * (jump / height) : 0;
    }

    /// Of every step of a curve, from the position of that number on. [um]
    std::vector<double> jumps_of(const std::vector<double> &te)
    {
      const std::size_t n = te.size();
      const auto rise = [&](const std::size_t k) { return te[(k + 1) % n] - te[k % n]; };
      std::vector<double> jumps(n);
      for (std::size_t k = 0; k < n; ++k)
        jumps[k] = jump_of(rise(k), rise(k + n - 1), rise(k + 1));
      return jumps;
    }

    /// What is known of a step with a jump, where the curve was computed halfway in it too. [um]
    struct HalvedStep
    {
      double beyond_smooth;        ///< what halfway is above the cubic curve through the next four positions
      std::array<double, 2> jumps; ///< of its halves
    };

    /// By their numbers, those of steps_of_jumps() that were computed halfway. None where two are neighbours:
    /// how high a contact is that one position alone has seen, halves at both its ends do not tell.
    std::map<std::size_t, HalvedStep> halved_steps_of(const std::vector<double> &te,
                                                      const CoarserDifferences &coarser, const double by_grid)
    {
      const std::size_t n = te.size();
      std::map<std::size_t, HalvedStep> halved;
      for (const int step : steps_of_jumps(te))
        if (const auto half = coarser.between.find(step + 0.5); half != coarser.between.end())
          {
            const auto k = static_cast<std::size_t>(step);
            const double value = half->second - by_grid, low = te[k], high = te[(k + 1) % n],
                         before = te[(k + n - 1) % n], after = te[(k + 2) % n];
            halved[k] = { value - (9 * (low + high) - before - after) / 16,
                          { jump_of(value - low, (low - before) / 2, high - value),
                            jump_of(high - value, value - low, (after - high) / 2) } };
          }
      if (std::ranges::any_of(halved,
                              [&](const auto &step) { return halved.contains((step.first + 1) % n); }))
        halved.clear();
      return halved;
    }

    /// What jumps of the curve, where a tooth pair takes or leaves its load at once, leave open of a
    /// harmonic: each lies somewhere within a step, and half a step changes the amplitude by its height over
    /// the positions of a cycle; what is known halfway leaves half of that. Those of a cycle lie at places of
    /// their own, but for a contact that one position alone has seen, both ends of which tell how long it is;
    /// those of other cycles at the same ones. [um]
    double open_by_jumps(const std::vector<double> &te, const int cycles,
                         const std::map<std::size_t, HalvedStep> &halved)
    {
      const std::vector<double> jumps = jumps_of(te);
      const std::size_t n = jumps.size();
      double squares = 0;
      for (std::size_t k = 0; k < n; ++k)
        {
          if (const auto halves = halved.find(k); halves == halved.end())
            squares += jumps[k] * jumps[k];
          else
            for (const double jump : halves->second.jumps)
              squares += jump * jump / 4;
          squares += 2 * std::max(0.0, -jumps[k] * jumps[(k + 1) % n]);
        }
      return of_place * std::sqrt(squares * cycles) / static_cast<double>(n);
    }

    /// By how much the amplitude of a harmonic changes when what is known halfway in steps with jumps counts:
    /// what lies there beyond a smooth curve, over half a step. [um]
    double moved_by_halves(const std::vector<double> &te, const Harmonic &harmonic, const int number,
                           const std::map<std::size_t, HalvedStep> &halved)
    {
      const auto n = static_cast<double>(te.size());
      const std::complex<double> known = std::polar(harmonic.amplitude, harmonic.phase);
      std::complex<double> moved = known;
      for (const auto &[k, step] : halved)
        moved +=
            std::polar(step.beyond_smooth / n, -2 * units::pi * number * (static_cast<double>(k) + 0.5) / n);
      return std::abs(std::abs(moved) - std::abs(known));
    }

    /// The area, over the period, of what stands out halfway between positions beyond both of them, as far as
    /// it was computed there, from cubic curves through the next four: of a contact of fewer tooth pairs that
    /// no position falls into, which is shorter than a step. [um]
    double area_between(const std::vector<double> &te, const CoarserDifferences &coarser,
                        const double by_grid)
    {
      const auto n = static_cast<std::ptrdiff_t>(te.size());
      double area = 0;
      for (const auto &[place, value] : coarser.between)
        {
          const auto at = [&](const std::ptrdiff_t k) {
            return te[static_cast<std::size_t>((static_cast<std::ptrdiff_t>(place) + k + n) % n)];
          };
          const double here = value - by_grid, smooth = (9 * (at(0) + at(1)) - at(-1) - at(2)) / 16;
          if (here > std::max(at(0), at(1)) || here < std::min(at(0), at(1))) // else a jump may be there
            area += of_step * std::abs(here - smooth) / static_cast<double>(n);
        }
      return area;
    }

    /// Peak-to-peak of a mesh cycle, the greatest over the cycles, judged by its positions alone: as they
    /// have it, and with what may hide between them. [um]
    struct PeakToPeakOfCycle
    {
      double seen = 0, with_hidden = 0;
    };

    PeakToPeakOfCycle peak_to_peak_of_cycle(const std::vector<double> &te, const int cycles)
    {
      const auto n = static_cast<std::ptrdiff_t>(te.size()) / cycles;
      PeakToPeakOfCycle of_cycles;
      for (int cycle = 0; cycle < cycles; ++cycle)
        {
          const std::vector<double> of_cycle(te.begin() + cycle * n, te.begin() + (cycle + 1) * n);
          const double seen = peak_to_peak(of_cycle);
          of_cycles.seen = std::max(of_cycles.seen, seen);
          of_cycles.with_hidden = std::max(of_cycles.with_hidden, seen + hidden_peaks(of_cycle, {}, 0));
        }
      return of_cycles;
    }
  } // namespace

  std::vector<int> steps_of_jumps(const std::vector<double> &te)
  {
    const std::vector<double> jumps = jumps_of(te);
    const auto height = [&](const int k) { return std::abs(jumps[static_cast<std::size_t>(k)]); };
    std::vector<int> steps(te.size());
    std::iota(steps.begin(), steps.end(), 0);
    std::ranges::stable_sort(steps, std::greater(), height);
    std::erase_if(steps,
                  [&, least = least_jump * peak_to_peak(te)](const int k) { return height(k) <= least; });
    steps.resize(std::min(steps.size(), std::size_t{ halved_steps }));
    return steps;
  }

  TransmissionErrorBounds nothing_known()
  {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return { .position = unknown,
             .mean = unknown,
             .mean_by_bodies = unknown,
             .mean_by_grid = unknown,
             .mean_by_positions = unknown,
             .shift = unknown,
             .oscillation = unknown,
             .peak_to_peak = unknown,
             .amplitude = { unknown, unknown, unknown } };
  }

  TransmissionErrorBounds error_bounds(const std::vector<double> &te, const std::vector<Harmonic> &spectrum,
                                       const int cycles, const CoarserDifferences &coarser)
  {
    const int positions = static_cast<int>(te.size()) / cycles;
    const Scatter grid = scatter(coarser.by_grid), bodies = scatter(coarser.by_bodies);
    const double deviation = grid.deviation + bodies.deviation;
    TransmissionErrorBounds bounds = nothing_known();
    bounds.mean_by_grid = of_mean * std::abs(grid.mean) + of_scatter * grid.deviation;
    bounds.mean_by_bodies = of_mean * std::abs(bodies.mean) + of_scatter * bodies.deviation;
    if (positions < fewest_positions)
      return bounds;
    const double noise = noise_of_harmonics(te);
    const double of_few = (positions < very_few ? 2.0 : positions < enough_positions ? 1.0 : 0.0) / positions;
    const PeakToPeakOfCycle of_cycles = peak_to_peak_of_cycle(te, cycles);
    bounds.peak_to_peak =
        std::max((of_few > 0 ? hidden_by_few : of_hidden) * hidden_peaks(te, coarser, grid.mean),
                 peak_to_peak_of_few * of_few * of_cycles.seen) +
        of_peak_to_peak * deviation + noise;
    const double between = area_between(te, coarser, grid.mean);
    const std::map<std::size_t, HalvedStep> halved = halved_steps_of(te, coarser, grid.mean);
    const bool knows_jumps = cycles == 1 && halved.size() == steps_of_jumps(te).size();
    const std::array<double, 4> &shares = knows_jumps ? of_folded : of_folded_alone;
    bounds.mean_by_positions = std::max({ folded(spectrum, cycles, positions, 0, shares),
                                          of_mean_by_jumps * open_by_jumps(te, cycles, {}), between,
                                          mean_of_few * of_few * of_cycles.with_hidden });
    bounds.mean = bounds.mean_by_grid + bounds.mean_by_bodies + bounds.mean_by_positions +
                  least_share * std::abs(scatter(te).mean);
    bounds.position = bounds.mean - bounds.mean_by_positions + of_position * deviation + noise;
    bounds.shift = -(grid.mean + bodies.mean) / 2;
    bounds.oscillation = deviation;
    for (std::size_t i = 0; i < bounds.amplitude.size(); ++i)
      {
        const int harmonic = static_cast<int>(i + 1);
        bounds.amplitude[i] =
            harmonic > positions / 2
                ? std::numeric_limits<double>::quiet_NaN()
                : std::max({ folded(spectrum, cycles, positions, harmonic, shares),
                             open_by_jumps(te, cycles, halved), 2 * between,
                             amplitude_of_few * of_few * of_cycles.with_hidden }) +
                      moved_by_halves(te, spectrum[static_cast<std::size_t>(harmonic * cycles - 1)],
                                      harmonic * cycles, halved) +
                      of_deviation[i] * deviation +
                      (harmonic == 1 ? least_of_first * std::abs(scatter(te).mean) : 0) + noise;
      }
    return bounds;
  }
} // namespace flank
