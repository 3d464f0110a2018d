// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/error_bounds.hpp"

#include "cases/results/harmonics.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  namespace
  {
    /// Shares of what coarser computations differ by, found on scenes of their own (validation/run coverage).
    constexpr double of_scatter = 0.5; ///< of the differences about their mean, in the mean of all positions
    constexpr double of_alias = 1.0 / 3; ///< of the harmonic that folds into one at half as many positions
    constexpr double least_share = 2e-4; ///< of the mean: what no estimate goes below

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

    double peak_to_peak(const std::vector<double> &values, const std::size_t from = 0,
                        const std::size_t step = 1)
    {
      double least = 1e300, greatest = -1e300;
      for (std::size_t k = from; k < values.size(); k += step)
        {
          least = std::min(least, values[k]);
          greatest = std::max(greatest, values[k]);
        }
      return std::max(0.0, greatest - least);
    }

    /// By how much the trigonometric polynomial through the values goes beyond them.
    double overshoot(const std::vector<double> &values, const std::vector<Harmonic> &spectrum)
    {
      constexpr int finer = 8;
      constexpr std::size_t most = 512; // more positions leave nothing between them
      if (values.size() > most)
        return 0;
      const auto n = static_cast<int>(values.size());
      std::vector<double> between(static_cast<std::size_t>(finer) * values.size());
      for (std::size_t k = 0; k < between.size(); ++k)
        for (std::size_t i = 0; i < spectrum.size(); ++i)
          between[k] += spectrum[i].amplitude * std::cos(2 * units::pi * static_cast<double>(i + 1) *
                                                             static_cast<double>(k) / (finer * n) +
                                                         spectrum[i].phase);
      return std::max(0.0, peak_to_peak(between) - peak_to_peak(values));
    }

    /// How much peak-to-peak may grow with ever more positions.
    double hidden_peaks(const std::vector<double> &te, const std::vector<Harmonic> &spectrum,
                        const CoarserDifferences &coarser, const double by_grid)
    {
      const auto [least, greatest] = std::minmax_element(te.begin(), te.end());
      double low = *least, high = *greatest;
      for (const double value : coarser.between)
        {
          low = std::min(low, value - by_grid);
          high = std::max(high, value - by_grid);
        }
      const double all = *greatest - *least, seen = high - low - all,
                   of_halves = all - std::min(peak_to_peak(te, 0, 2), peak_to_peak(te, 1, 2));
      return std::max({ 2 * seen, overshoot(te, spectrum) / 2, of_halves / 2 });
    }
  } // namespace

  TransmissionErrorBounds error_bounds(const std::vector<double> &te, const std::vector<Harmonic> &spectrum,
                                       const int cycles, const CoarserDifferences &coarser)
  {
    const Scatter grid = scatter(coarser.by_grid), bodies = scatter(coarser.by_bodies);
    const double deviation = grid.deviation + bodies.deviation;
    const auto half = static_cast<int>(spectrum.size());
    // At half as many positions the harmonic half - i is taken for i; what folds into it now is smaller.
    const auto folded = [&](const int i) {
      const int from = std::min(half, std::max(half - i, i + 1));
      return half > 0 ? spectrum[static_cast<std::size_t>(from - 1)].amplitude : 0;
    };
    TransmissionErrorBounds bounds;
    bounds.mean_by_grid = std::abs(grid.mean) + of_scatter * grid.deviation;
    bounds.mean_by_bodies = std::abs(bodies.mean) + of_scatter * bodies.deviation;
    bounds.mean_by_positions = folded(0);
    bounds.mean = bounds.mean_by_grid + bounds.mean_by_bodies + bounds.mean_by_positions +
                  least_share * std::abs(scatter(te).mean);
    bounds.shift = -(grid.mean + bodies.mean) / 2;
    bounds.oscillation = deviation;
    bounds.peak_to_peak = hidden_peaks(te, spectrum, coarser, grid.mean) + 2 * std::sqrt(2.0) * deviation;
    for (std::size_t i = 0; i < bounds.amplitude.size(); ++i)
      bounds.amplitude[i] = of_alias * folded(static_cast<int>(i + 1) * cycles) + deviation;
    return bounds;
  }
} // namespace flank
