// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/between_positions.hpp"
#include "cases/parallel_axis/extras/coarser_case.hpp"
#include "cases/parallel_axis/extras/coarser_positions.hpp"
#include "cases/parallel_axis/extras/errors_of_torque.hpp"
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/extras/pressure_kind.hpp"
#include "cases/parallel_axis/extras/root_stress_error.hpp"
#include "cases/parallel_axis/pair/accuracy_level.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "cases/parallel_axis/pair/cost.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/error_bounds.hpp"
#include "cases/results/shown_number.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <ranges>

namespace flank
{
  namespace
  {
    class ErrorEstimateByCoarser : public Extra
    {
    public:
      std::string name() const override { return error_estimate_name; }

      ExtraPlan plan(const ParallelAxisCase &input) const override
      {
        const ParallelAxisCase coarse = coarser_case(input);
        if (!without_coarser(input).empty())
          return { .computed = {},
                   .left_out = { "error estimate: there is no coarser " + without_coarser(input) +
                                 " than this case's to compare with; let accuracy set it" } };
        return { .computed = { fmt::format(
                     "error estimate: {} on a grid of {} by {} cells, with these bodies and "
                     "with coarser ones ({} by {} elements on a flank){}",
                     counted(sampled_positions(input.positions).size(), "position"), coarse.grid.slices,
                     coarse.grid.profile_cells, coarse.pinion_mesh.flank_rows, coarse.pinion_mesh.face_layers,
                     asks_for_root_stress(input) ? "; the greatest root stress of each torque on "
                                                   "coarser bodies and halfway beside its position"
                                                 : "") },
                 .left_out = {} };
      }

      ExtraCost cost(const ParallelAxisCase &input, const int processes) const override
      {
        if (!without_coarser(input).empty())
          return {};
        ParallelAxisCase coarse = coarser_case(input);
        coarse.positions = 2 * static_cast<int>(sampled_positions(input.positions).size()) + 7;
        const CostEstimate estimate = estimate_cost(coarse, processes);
        return { .seconds = estimate.reduction_seconds + estimate.contact_seconds,
                 .gigabytes = estimate.gigabytes,
                 .reduction_seconds = estimate.reduction_seconds };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        std::vector<ErrorsOfTorque> estimates;
        for (const auto &at : run.at)
          estimates.push_back({ .kind = pressure_kind(run.input, at) });
        if (without_coarser(run.input).empty())
          estimate(run, estimates);
        if (run.work.rank() != 0)
          return {};
        return { .summary = summary_of(run, estimates),
                 .table = table_of(run.input, estimates),
                 .bounds = std::move(estimates) };
      }

    private:
      static void estimate(const FinishedRun &run, std::vector<ErrorsOfTorque> &estimates)
      {
        const ParallelAxisCase coarse = coarser_case(run.input);
        StageClock clock;
        std::string failure;
        const auto bodies =
            reduced_bodies(coarse.bodies(), OperatorCache::of_user(), run.work.session(), clock, &failure);
        if (!failure.empty())
          {
            spdlog::warn("no error estimate: the coarser bodies cannot be computed: {}", failure);
            return;
          }
        ParallelAxisCase on_coarse_grid = run.input;
        on_coarse_grid.grid = coarse.grid;
        const int n = run.input.positions;
        const std::vector<int> sampled = sampled_positions(n);
        std::vector<int> all(run.input.torques.size());
        std::iota(all.begin(), all.end(), 0);
        std::vector<CoarseJob> wanted;
        for (const int k : sampled)
          for (const bool coarse_bodies : { false, true })
            wanted.push_back({ 1.0 * k / n, coarse_bodies, all });
        const auto halves =
            halves_wanted(run, [&](const std::size_t t) { return halves_of_contact(run.input, run.at[t]); });
        const auto of_roots = halves_wanted(run, [&](const std::size_t t) {
          std::vector<int> places;
          for (const int peak : peaks_of_root_stress(run, t))
            places.insert(places.end(), { 2 * peak - 1, 2 * peak, 2 * peak + 1 });
          return places;
        });
        for (const auto &[half, torques] : halves)
          wanted.push_back({ 0.5 * half / n, false, torques });
        for (const auto &[half, torques] : of_roots)
          wanted.push_back({ 0.5 * half / n, false, torques, true });
        auto found = solve_coarser(wanted, loaded_pair(on_coarse_grid, run.bodies.bodies()),
                                   loaded_pair(coarse, bodies), run.input.torques, run.work);
        if (run.work.rank() != 0)
          return;
        const std::size_t first_half = 2 * sampled.size();
        for (std::size_t t = 0; t < estimates.size(); ++t)
          estimates[t] = estimate_of_torque(run, t, sampled, halves_of(t, halves, first_half, found), found);
        if (LoadedBodies coarser(bodies, coarse.body); !run.root_stresses.empty())
          for (std::size_t t = 0; t < estimates.size(); ++t)
            add_root_stress(run, t, halves_of(t, of_roots, first_half + halves.size(), found), coarser,
                            estimates[t]);
      }

      /// What was found at a torque at some places; theirs are those from `first` on.
      static Halves halves_of(const std::size_t t, const std::map<int, std::vector<int>> &places,
                              const std::size_t first, std::vector<std::vector<PositionResult>> &found)
      {
        Halves halves;
        std::size_t j = first;
        for (const auto &[half, torques] : places)
          if (PositionResult &result = found[j++][t]; result.failure.empty())
            halves.emplace(0.5 * half, std::move(result));
        return halves;
      }

      static void add_root_stress(const FinishedRun &run, const std::size_t t, const Halves &halves,
                                  LoadedBodies &coarser, ErrorsOfTorque &errors)
      try
        {
          errors.root_stress = root_stress_errors(run, t, halves, coarser);
        }
      catch (const ComputationError &error)
        {
          spdlog::warn("no error estimate of root stress at {:.6g} N m: {}",
                       run.input.torques[t] / units::newton_metre, error.what());
        }

      /// `found`: at every sampled position the coarser grid, then the coarser bodies too.
      static ErrorsOfTorque estimate_of_torque(const FinishedRun &run, const std::size_t t,
                                               const std::vector<int> &sampled, const Halves &halves,
                                               const std::vector<std::vector<PositionResult>> &found)
      {
        std::vector<CoarserSample> samples;
        for (std::size_t s = 0; s < sampled.size(); ++s)
          if (const auto &grid = found[2 * s][t], &all = found[2 * s + 1][t];
              grid.failure.empty() && all.failure.empty())
            samples.push_back({ run.at[t][static_cast<std::size_t>(sampled[s])], grid, all });
        const double torque = run.input.torques[t] / units::newton_metre;
        if (2 * samples.size() < sampled.size() || samples.size() < 2)
          {
            spdlog::warn(
                "no error estimate at {:.6g} N m: a coarser contact grid does not resolve this contact",
                torque);
            return { .kind = pressure_kind(run.input, run.at[t]) };
          }
        if (samples.size() < sampled.size())
          spdlog::warn("error estimate at {:.6g} N m from {} instead of {}: a coarser contact grid "
                       "does not resolve the others",
                       torque, counted(samples.size(), "position"), sampled.size());
        return errors_of_torque(run.input, run.at[t], samples, halves);
      }

      static std::string with_error(const double value, const double error, const int digits)
      {
        if (std::isnan(error))
          return shown_number(value, digits) + " (not estimated)";
        constexpr double least_shown = 1e-6;
        if (error < least_shown)
          return fmt::format("{:.{}f} +- <{:.0e}", value, digits, least_shown);
        // Two digits of an error that is smaller than the digits shown.
        const int shown = std::max(digits, 1 - static_cast<int>(std::floor(std::log10(error))));
        return fmt::format("{:.{}f} +- {:.{}f}", value, shown, error, shown);
      }

      static std::string percent(const double error)
      {
        return std::isnan(error) ? "not estimated" : fmt::format("+- {:.2f} %", 100 * error);
      }

      static std::string summary_of(const FinishedRun &run, const std::vector<ErrorsOfTorque> &estimates)
      {
        const auto row = [](const auto &...cells) {
          return fmt::format("{:>10} {:>20} {:>19} {:>18} {:>18} {:>18} {:>20} {:>14}\n", cells...);
        };
        std::string lines = "results with their errors: upper bounds, by coarser bodies and grids and by the "
                            "positions (error_estimate.csv has more)\n" +
                            row("torque", "mean TE", "p-p TE", "A1", "A2", "A3", "pressure", "load share") +
                            row("N m", "um", "um", "um", "um", "um", "MPa", "");
        for (std::size_t t = 0; t < estimates.size(); ++t)
          {
            const ErrorsOfTorque &e = estimates[t];
            const std::vector<double> te = errors_over_cycle(run.input.pair, run.at[t]);
            const auto [least, greatest] = std::minmax_element(te.begin(), te.end());
            const auto spectrum = mesh_harmonics(harmonics(te), run.input.cycles);
            const auto amplitude = [&](const std::size_t i) {
              return i < spectrum.size() ? with_error(spectrum[i].amplitude, e.te.amplitude[i], 4)
                                         : std::string("-");
            };
            const double pressure = greatest_pressures(run.at[t]).inside;
            lines += row(shown_torque(run.input.torques[t]),
                         with_error(mean_error_um(run.input.pair, run.at[t]), e.te.mean, 4),
                         with_error(*greatest - *least, e.te.peak_to_peak, 4), amplitude(0), amplitude(1),
                         amplitude(2),
                         e.kind == PressureKind::regular ? with_error(pressure, e.pressure * pressure, 1)
                         : e.kind == PressureKind::kink
                             ? shown_number(pressure, 1) +
                                   (e.regular_pressure < pressure ? " at a kink" : ", a kink near")
                         : pressure > 0 ? shown_number(pressure, 1) + ", more at edges"
                                        : shown_pressure(run.at[t]),
                         std::isnan(e.load_share) ? "not estimated" : fmt::format("+- {:.4f}", e.load_share));
          }
        for (std::size_t t = 0; t < estimates.size(); ++t)
          if (const ErrorsOfTorque &e = estimates[t]; e.kind != PressureKind::regular && e.pressure > 0)
            lines += fmt::format("greatest pressure away from kinks and edges at {} N m: {} MPa\n",
                                 shown_torque(run.input.torques[t]),
                                 with_error(e.regular_pressure, e.pressure * e.regular_pressure, 1));
        for (std::size_t t = 0; t < estimates.size(); ++t)
          if (const auto &[pinion, gear] = estimates[t].root_stress;
              asks_for_root_stress(run.input) && run.input.torques[t] > 0)
            lines += fmt::format("root stress at {} N m: pinion {}, gear {}\n",
                                 shown_torque(run.input.torques[t]), percent(pinion), percent(gear));
        return lines;
      }

      static ResultTable table_of(const ParallelAxisCase &input, const std::vector<ErrorsOfTorque> &estimates)
      {
        std::vector<std::string> levels;
        for (const AccuracyLevel &level : accuracy_levels())
          levels.push_back(level.name);
        ResultTable table(
            "error_estimate",
            std::string(conventions) +
                "# upper bounds of the absolute errors of elements, contact grid and positions, from coarser "
                "bodies and grids at some positions; nan: not estimated\n"
                "# mean_te_shift_um is signed: what finer bodies and grids are expected to add to the mean; "
                "pressure_kind kink or edge: the greatest pressure grows as cells shrink, at or near a kink "
                "of a flank, or at edges that carry more than the flanks inside; regular_pressure_MPa: the "
                "greatest "
                "away from both, with its bound\n",
            { torque_column(),
              { "level", "", "{}", levels },
              { "compared_with", "", "{}", { "coarser" } },
              bound_column("mean_te_um", "um"),
              bound_column("te_rms_um", "um"),
              bound_column("peak_to_peak_te_um", "um"),
              bound_column("A1_um", "um"),
              bound_column("max_pressure_percent", "%"),
              bound_column("A2_um", "um"),
              bound_column("A3_um", "um"),
              bound_column("load_share", "1"),
              { "mean_te_shift_um", "um", "{:.9g}", {}, "nan" },
              bound_column("mean_te_by_bodies_um", "um"),
              bound_column("mean_te_by_grid_um", "um"),
              bound_column("mean_te_by_positions_um", "um"),
              { "pressure_kind", "", "{}", pressure_kinds() },
              bound_column("root_stress_pinion_percent", "%"),
              bound_column("root_stress_gear_percent", "%"),
              { "regular_pressure_MPa", "MPa", "{:.9g}", {}, "nan" },
              bound_column("regular_pressure_percent", "%") });
        const double level =
            static_cast<double>(std::find(levels.begin(), levels.end(), input.level) - levels.begin());
        for (std::size_t t = 0; t < estimates.size(); ++t)
          {
            const auto &[kind, te, regular, pressure, share, root, of_positions] = estimates[t];
            table.add({ input.torques[t] / units::newton_metre,
                        level,
                        0,
                        te.mean,
                        te.oscillation,
                        te.peak_to_peak,
                        te.amplitude[0],
                        kind == PressureKind::regular ? 100 * pressure : ErrorsOfTorque::unknown,
                        te.amplitude[1],
                        te.amplitude[2],
                        share,
                        te.shift,
                        te.mean_by_bodies,
                        te.mean_by_grid,
                        te.mean_by_positions,
                        static_cast<double>(kind),
                        100 * root[0],
                        100 * root[1],
                        regular,
                        100 * pressure });
          }
        return table;
      }
    };
  } // namespace

  ExtraKind error_estimate()
  {
    const std::string key = "output.error_estimate";
    return { .name = error_estimate_name,
             .keys = { keys::text(key, "yes",
                                  "yes: bounds of the errors of elements, contact grid and positions, from "
                                  "coarser ones at some positions, in a study of its first variant; "
                                  "every_variant: of all of them",
                                  { "no", "yes", "every_variant" }) },
             .files = { "error_estimate.csv", "error_estimates.csv" },
             .left_out = "error estimate: not asked for (" + key + ")",
             .asked = [key](const CaseFile &file, const ParallelAxisCase &) -> std::shared_ptr<const Extra> {
               if (file.text(key) == "every_variant")
                 file.require_study(key, "variants are of studies (yes is for a run)");
               return file.text(key) != "no" ? std::make_shared<ErrorEstimateByCoarser>() : nullptr;
             } };
  }
} // namespace flank
