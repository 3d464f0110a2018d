// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/error_estimate.hpp"

#include "cases/results/harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  namespace
  {
    /// What is compared, of one torque.
    struct Measures
    {
      Measures(const ParallelAxisCase &input, const std::vector<PositionResult> &positions)
      {
        for (int k = 0; k < input.positions; ++k)
          {
            curve.push_back(transmission_error_um(input.pair, positions[k]));
            pressure = std::max(pressure, positions[k].max_pressure);
          }
        const auto [least, greatest] = std::minmax_element(curve.begin(), curve.end());
        peak_to_peak                 = *greatest - *least;
        mean = std::accumulate(curve.begin(), curve.end(), 0.0) / static_cast<double>(curve.size());
        if (curve.size() > 1)
          first_harmonic = harmonics(curve)[0].amplitude;
      }
      std::vector<double> curve;
      double              mean = 0, peak_to_peak = 0, first_harmonic = 0, pressure = 0;
    };
  } // namespace

  std::vector<ErrorEstimate> error_estimate(const ParallelAxisCase &input, const ParallelAxisResults &results,
                                            const ParallelAxisResults &at_other_level)
  {
    std::vector<ErrorEstimate> estimates;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const Measures here(input, results.at[t]), there(input, at_other_level.at[t]);
        double         squares = 0;
        for (std::size_t k = 0; k < here.curve.size(); ++k)
          squares += std::pow(here.curve[k] - here.mean - there.curve[k] + there.mean, 2);
        estimates.push_back({ std::abs(here.mean - there.mean),
                              std::sqrt(squares / static_cast<double>(here.curve.size())),
                              std::abs(here.peak_to_peak - there.peak_to_peak),
                              std::abs(here.first_harmonic - there.first_harmonic),
                              here.pressure > 0 ? std::abs(1 - there.pressure / here.pressure) : 0 });
      }
    return estimates;
  }
} // namespace flank
