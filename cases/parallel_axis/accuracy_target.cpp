// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/accuracy_target.hpp"

#include "cases/parallel_axis/pair/accuracy_level.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/plan.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    const std::string key = "accuracy.mean_te_percent";
    constexpr int most_grid_steps = 3, most_positions = 512;

    /// Cells after some steps of refinement: half as many again at each, an odd number.
    int finer(const int cells, const int steps)
    {
      return steps == 0 ? cells : 2 * static_cast<int>(std::lround(cells * std::pow(1.5, steps) / 2)) + 1;
    }
  } // namespace

  AccuracyTarget::AccuracyTarget(const CaseFile &file)
      : file_(file)
  {
    if (!file.has(key))
      return;
    percent_ = file.number(key);
    if (file.text("output.error_estimate") == "no")
      throw InputError(
          file.place(key) +
          "contradicts output.error_estimate = no: only the estimate can tell that it is reached");
    const auto &levels = accuracy_levels();
    while (level_ + 1 < levels.size() && levels[level_].expected.stated_mean_te > percent_)
      ++level_;
  }

  CaseFile AccuracyTarget::now() const
  {
    if (percent_ == 0)
      return file_;
    const AccuracyLevel &level = accuracy_levels()[level_];
    std::vector<std::string> settings = { "accuracy=" + level.name };
    const auto set = [&](const char *of, const int value) {
      if (!file_.has(of))
        settings.push_back(fmt::format("{}={}", of, value));
    };
    if (grid_steps_ > 0)
      {
        set("contact_grid.slices", finer(level.grid.slices, grid_steps_));
        set("contact_grid.profile_cells", finer(level.grid.profile_cells, grid_steps_));
      }
    if (positions_steps_ > 0)
      set("mesh_cycle.positions", file_.integer("mesh_cycle.positions") << positions_steps_);
    return file_.with(settings, file_.place(key) + "then");
  }

  AccuracyTarget::Stated AccuracyTarget::stated(const WholeRun &run)
  {
    Stated worst;
    const ExtraOutput *estimate = run.with_bounds();
    for (std::size_t t = 0; t < run.results.at.size(); ++t)
      if (run.input.torques[t] > 0)
        {
          const double mean = std::abs(mean_error_um(run.input.pair, run.results.at[t])) / 100;
          if (!estimate || std::isnan(estimate->bounds.at(t).mean) || mean == 0)
            return { .mean = std::numeric_limits<double>::infinity() };
          if (const auto &of = estimate->bounds[t]; of.mean / mean > worst.mean)
            worst = { .mean = of.mean / mean,
                      .by_bodies = of.mean_by_bodies / mean,
                      .by_grid = of.mean_by_grid / mean,
                      .by_positions = of.mean_by_positions / mean };
        }
    return worst;
  }

  bool AccuracyTarget::reached(const WholeRun &run) const
  {
    return percent_ == 0 || stated(run).mean <= percent_;
  }

  bool AccuracyTarget::refine_level()
  {
    if (level_ + 1 == accuracy_levels().size())
      return false;
    ++level_;
    return true;
  }

  bool AccuracyTarget::refine_grid()
  {
    if (grid_steps_ == most_grid_steps ||
        (file_.has("contact_grid.slices") && file_.has("contact_grid.profile_cells")))
      return false;
    ++grid_steps_;
    return true;
  }

  bool AccuracyTarget::refine_positions()
  {
    const int finer = file_.integer("mesh_cycle.positions") << (positions_steps_ + 1);
    if (file_.has("mesh_cycle.positions") || finer > most_positions)
      return false;
    ++positions_steps_;
    return true;
  }

  bool AccuracyTarget::refine(const WholeRun &run, const SharedWork &work)
  {
    std::vector<char> refined(1, 0);
    const auto before = std::tuple(level_, grid_steps_, positions_steps_);
    if (work.rank() == 0)
      {
        const Stated at = stated(run);
        // Every part that takes more than a third of what is allowed; if none does, the greatest one.
        const double greatest = std::max({ at.by_bodies, at.by_grid, at.by_positions }),
                     limit = std::min(percent_ / 3, greatest);
        const auto ask = [&](const double part, bool (AccuracyTarget::*finer)()) {
          if (part >= limit && (this->*finer)())
            refined[0] = 1;
        };
        ask(at.by_bodies, &AccuracyTarget::refine_level);
        ask(at.by_grid, &AccuracyTarget::refine_grid);
        ask(at.by_positions, &AccuracyTarget::refine_positions);
        // What cannot be had where the error comes from may be saved elsewhere.
        if (!refined[0] && (refine_level() || refine_grid() || refine_positions()))
          refined[0] = 1;
        refined.push_back(static_cast<char>(level_));
        refined.push_back(static_cast<char>(grid_steps_));
        refined.push_back(static_cast<char>(positions_steps_));
      }
    if (work.session())
      work.session()->broadcast(refined);
    level_ = static_cast<std::size_t>(refined[1]);
    grid_steps_ = refined[2];
    positions_steps_ = refined[3];
    return refined[0] != 0 && before != std::tuple(level_, grid_steps_, positions_steps_);
  }

  std::string AccuracyTarget::describe(const WholeRun &run) const
  {
    if (percent_ == 0)
      return {};
    const double mean = stated(run).mean;
    return fmt::format(
        "accuracy: {:.4g} % of the mean transmission error was asked for, {} is stated: {} level, {} "
        "by {} cells, {} positions",
        percent_, std::isinf(mean) ? "nothing" : fmt::format("{:.2g} %", mean), run.input.level,
        run.input.grid.slices, run.input.grid.profile_cells, run.input.positions);
  }

  std::string AccuracyTarget::plan() const
  {
    if (percent_ == 0)
      return {};
    return fmt::format(
        "This is the first try of {:.4g} % of the mean transmission error: what states more is computed "
        "again, finer where its error comes from\n",
        percent_);
  }

  void refuse_accuracy_target(const CaseFile &file)
  {
    if (file.has(key))
      throw InputError(
          file.place(key) +
          "is of runs: the variants of a study have one level, accuracy = \"standard\" for instance");
  }

  std::string levels_report(const CaseFile &file, const int processes)
  {
    std::string report =
        "Levels of accuracy: time, and errors as they were (median, in % of each quantity; draft and "
        "standard over 59 scenes of 16 positions, which peak-to-peak feels most, reference on two examples "
        "at the same positions; the results state their own)\n"
        "              time     mean TE   p-p TE       A1   pressure\n";
    for (const AccuracyLevel &level : accuracy_levels())
      {
        const CostEstimate cost = estimate_cost(
            read_parallel_axis(file.with({ "accuracy=" + level.name }, file.file())), processes);
        report += fmt::format("  {:<10} {:>6} s {:>11} {:>8} {:>8} {:>10}\n", level.name,
                              two_digits(cost.seconds()), level.expected.mean_te, level.expected.peak_to_peak,
                              level.expected.a1, level.expected.pressure);
      }
    return report;
  }
} // namespace flank
