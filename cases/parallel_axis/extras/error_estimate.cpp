// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/input/input.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/plan.hpp"
#include "cases/results/harmonics.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  namespace
  {
    /// How much results at one torque differ from those of another accuracy level; absolute values.
    struct ErrorEstimate
    {
      double mean, oscillation;            ///< of TE: its mean, root mean square of the rest [um]
      double peak_to_peak, first_harmonic; ///< of TE [um]
      double pressure;                     ///< greatest inside the flanks, over that of this level
    };

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
        peak_to_peak = *greatest - *least;
        mean = std::accumulate(curve.begin(), curve.end(), 0.0) / static_cast<double>(curve.size());
        if (curve.size() > 1)
          first_harmonic = harmonics(curve)[0].amplitude;
      }
      std::vector<double> curve;
      double mean = 0, peak_to_peak = 0, first_harmonic = 0, pressure = 0;
    };

    /// How much the first mesh cycles differ, torque by torque; the same torques and positions at both
    /// levels.
    std::vector<ErrorEstimate> differences(const ParallelAxisCase &input, const PositionsOfTorques &at,
                                           const PositionsOfTorques &at_other_level)
    {
      std::vector<ErrorEstimate> estimates;
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const Measures here(input, at[t]), there(input, at_other_level[t]);
          double squares = 0;
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

    class ErrorEstimateByLevels : public Extra
    {
    public:
      explicit ErrorEstimateByLevels(ParallelAxisCase other_level)
          : other_(std::move(other_level))
      {
      }

      std::string name() const override { return "error estimate"; }

      ExtraPlan plan(const ParallelAxisCase &) const override
      {
        return {
          { fmt::format("error estimate: the same bodies and contacts at the {} level", other_.level) }, {}
        };
      }

      ExtraCost cost(const ParallelAxisCase &, const int processes) const override
      {
        const CostEstimate other = estimate_cost(other_, processes);
        return { .seconds = other.reduction_seconds + other.contact_seconds, .gigabytes = other.gigabytes };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        const ParallelAxisResults other = run_parallel_axis(other_, { run.work.session(), nullptr });
        if (run.work.rank() != 0)
          return {};
        const auto estimates = differences(run.input, run.at, other.at);
        return { .summary = summary_of(run.input, estimates),
                 .table = table_of(run.input, estimates),
                 .patterns = {} };
      }

    private:
      std::string summary_of(const ParallelAxisCase &input, const std::vector<ErrorEstimate> &estimates) const
      {
        std::string lines =
            fmt::format("error estimate: by how much results of the {} level differ\n{:>10} {:>12} {:>12} "
                        "{:>12} {:>12} {:>12}\n",
                        other_.level, "torque", "mean TE", "TE rms", "p-p TE", "A1", "pressure");
        lines +=
            fmt::format("{:>10} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "N m", "um", "um", "um", "um", "%");
        for (std::size_t t = 0; t < estimates.size(); ++t)
          {
            const ErrorEstimate &e = estimates[t];
            lines += fmt::format("{:>10.3f} {:>12.4f} {:>12.4f} {:>12.4f} {:>12.4f} {:>12.2f}\n",
                                 input.torques[t] / units::newton_metre, e.mean, e.oscillation,
                                 e.peak_to_peak, e.first_harmonic, 100 * e.pressure);
          }
        return lines;
      }

      ResultTable table_of(const ParallelAxisCase &input, const std::vector<ErrorEstimate> &estimates) const
      {
        const std::vector<std::string> levels = { "draft", "standard", "reference" };
        const auto number = [&](const std::string &level) {
          return static_cast<double>(std::find(levels.begin(), levels.end(), level) - levels.begin());
        };
        ResultTable table("error_estimate",
                          conventions + fmt::format("# absolute differences of the {} level's results from "
                                                    "the {} level's; of the finer of the two an upper "
                                                    "estimate of its error\n",
                                                    input.level, other_.level),
                          { torque_column(),
                            { "level", "", "{}", levels },
                            { "compared_with", "", "{}", levels },
                            { "mean_te_um", "um", "{:.6f}" },
                            { "te_rms_um", "um", "{:.6f}" },
                            { "peak_to_peak_te_um", "um", "{:.6f}" },
                            { "A1_um", "um", "{:.6f}" },
                            { "max_pressure_percent", "%", "{:.4f}" } });
        for (std::size_t t = 0; t < estimates.size(); ++t)
          {
            const ErrorEstimate &e = estimates[t];
            table.add({ input.torques[t] / units::newton_metre, number(input.level), number(other_.level),
                        e.mean, e.oscillation, e.peak_to_peak, e.first_harmonic, 100 * e.pressure });
          }
        return table;
      }

      ParallelAxisCase other_; ///< the same case one level coarser (draft: finer)
    };
  } // namespace

  ExtraKind error_estimate()
  {
    return on_request(
        "output.error_estimate",
        "the case is computed one accuracy level coarser too (draft: finer), and by how much the results "
        "differ is told",
        "error_estimate.csv", "error estimate by another accuracy level",
        [](const CaseFile &file, const ParallelAxisCase &input) {
          return std::make_shared<ErrorEstimateByLevels>(read_pair(file.with(
              { input.level == "standard" ? "accuracy=draft" : "accuracy=standard" }, "error estimate: ")));
        });
  }
} // namespace flank
