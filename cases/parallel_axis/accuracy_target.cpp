// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/accuracy_target.hpp"

#include "cases/parallel_axis/extras/coarser_case.hpp"
#include "cases/parallel_axis/pair/accuracy_level.hpp"
#include "cases/parallel_axis/pair/cost.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/error_bounds.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/study/study_work.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace flank
{
  namespace
  {
    const std::string key = "accuracy.mean_te_percent";
    constexpr int most_grid_steps = 3, most_positions = 512;

    /// What follows the last level: meshes of levels with elements of a degree more, which state half of its
    /// error at once, in twice its time (validation/README.md, accuracy and time).
    constexpr std::array higher_degree_of_level = { std::size_t(1), std::size_t(2) };
    constexpr int higher_degree = 3;

    /// Whether the slope of a modification jumps where it starts.
    bool turns_suddenly(const MeshDeviations &deviations)
    {
      return std::ranges::any_of(std::array{ &deviations.pinion, &deviations.gear }, [](const auto *flank) {
        return std::ranges::any_of(flank->modifications, [](const auto &modification) {
          const auto turn = modification->turn();
          return std::min(turn.along_profile, turn.along_face) == 0;
        });
      });
    }

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
    while (now_.level + 1 < levels.size() && levels[now_.level].expected.stated_mean_te > percent_)
      ++now_.level;
  }

  CaseFile AccuracyTarget::now() const
  {
    if (percent_ == 0)
      return file_;
    const auto &levels = accuracy_levels();
    const bool beyond = now_.level >= levels.size();
    const AccuracyLevel &level = beyond ? levels.back() : levels[now_.level];
    std::vector<std::string> settings = { "accuracy=" + level.name };
    const auto set = [&](const char *of, const int value) {
      if (!file_.has(of))
        settings.push_back(fmt::format("{}={}", of, value));
    };
    if (beyond)
      {
        settings.front() = "accuracy=" + levels[higher_degree_of_level[now_.level - levels.size()]].name;
        set("mesh.degree", higher_degree);
      }
    if (beyond || now_.grid > 0)
      {
        set("contact_grid.slices", finer(level.grid.slices, now_.grid));
        set("contact_grid.profile_cells", finer(level.grid.profile_cells, now_.grid));
      }
    if (now_.positions > 0)
      {
        set("mesh_cycle.positions", file_.integer("mesh_cycle.positions") << now_.positions);
        if (file_.has("output.field_positions")) // fields stay at their phases
          {
            std::vector<double> positions = file_.numbers("output.field_positions");
            for (double &position : positions)
              position = std::ldexp(position, now_.positions);
            settings.push_back(fmt::format("output.field_positions=[{}]", fmt::join(positions, ", ")));
          }
      }
    return file_.with(settings, file_.place(key) + "then");
  }

  std::string AccuracyTarget::before_names_of_try() const
  {
    const auto &[level, grid, positions] = now_;
    return percent_ == 0 ? "" : fmt::format("try {} {} {}, ", level, grid, positions);
  }

  AccuracyTarget::Stated AccuracyTarget::stated(const WholeRun &run)
  {
    Stated worst;
    const std::vector<ErrorsOfTorque> &errors = run.results.errors;
    for (std::size_t t = 0; t < run.results.at.size(); ++t)
      if (run.input.torques[t] > 0)
        {
          const double mean = std::abs(mean_error_um(run.input.pair, run.results.at[t])) / 100;
          if (errors.empty() || std::isnan(errors[t].te.mean) || mean == 0)
            return { .mean = std::numeric_limits<double>::infinity() };
          if (const auto &of = errors[t].te; of.mean / mean > worst.mean)
            worst = { .mean = of.mean / mean,
                      .by_bodies = of.mean_by_bodies / mean,
                      .by_grid = of.mean_by_grid / mean,
                      .by_positions = of.mean_by_positions / mean };
        }
    return worst;
  }

  void AccuracyTarget::require_estimate(const ParallelAxisCase &input) const
  {
    if (percent_ == 0)
      return;
    const auto refuse = [&](const std::string &why) { throw InputError(file_.place(key) + why); };
    if (std::ranges::none_of(input.torques, [](const double torque) { return torque > 0; }))
      refuse("needs a torque above 0: without a load there is no mean that an error is a share of");
    if (const std::string least = without_coarser(input); !least.empty())
      refuse("cannot be stated: there is no coarser " + least +
             " than this case's to compare with; leave it out");
  }

  bool AccuracyTarget::reached(const WholeRun &run) const
  {
    return percent_ == 0 || stated(run).mean <= percent_;
  }

  bool AccuracyTarget::refine_level()
  {
    const std::size_t next = now_.level + 1, levels = accuracy_levels().size();
    if (next == levels + higher_degree_of_level.size() || (next == levels && file_.has("mesh.degree")))
      return false;
    ++now_.level;
    return true;
  }

  bool AccuracyTarget::has_own_grid() const
  {
    return file_.has("contact_grid.slices") && file_.has("contact_grid.profile_cells");
  }

  bool AccuracyTarget::refine_grid()
  {
    if (now_.grid == most_grid_steps || has_own_grid())
      return false;
    ++now_.grid;
    return true;
  }

  bool AccuracyTarget::refine_positions()
  {
    const int finer = file_.integer("mesh_cycle.positions") << (now_.positions + 1);
    if (file_.has("mesh_cycle.positions") || finer > most_positions)
      return false;
    ++now_.positions;
    return true;
  }

  std::string AccuracyTarget::out_of_reach(const Stated &at) const
  {
    const auto can = [&](bool (AccuracyTarget::*finer)()) { return (AccuracyTarget(*this).*finer)(); };
    const bool level = can(&AccuracyTarget::refine_level);
    const auto leaves = [](const char *what, const double part) {
      return fmt::format("{} leaves {:.2g} %", what, part);
    };
    if (file_.has("mesh_cycle.positions") && file_.integer("mesh_cycle.positions") < fewest_positions)
      return "the case sets too few positions";
    if (at.by_bodies > percent_ && !level)
      return leaves("the finest mesh of the search, with the case's own keys,", at.by_bodies);
    if (at.by_grid > percent_ && !can(&AccuracyTarget::refine_grid) &&
        (has_own_grid() || now_.level + 1 >= accuracy_levels().size()))
      return leaves("the finest contact grid, or the case's own,", at.by_grid);
    if (at.by_positions > percent_ && !can(&AccuracyTarget::refine_positions))
      return leaves(file_.has("mesh_cycle.positions") ? "mesh_cycle.positions, which the case sets,"
                                                      : "the greatest number of positions",
                    at.by_positions);
    const bool grid = can(&AccuracyTarget::refine_grid), positions = can(&AccuracyTarget::refine_positions);
    const double finer = (level ? at.by_bodies : 0) + (grid ? at.by_grid : 0) +
                         (positions ? at.by_positions : 0); // what could still be taken away
    if (at.mean - finer > percent_)
      return leaves("what nothing finer in the search, with the case's own keys, takes away",
                    at.mean - finer);
    return {};
  }

  bool AccuracyTarget::refine_most(const Stated &at)
  {
    // Every part that takes more than a third of what is allowed; if none does, the greatest one.
    const double greatest = std::max({ at.by_bodies, at.by_grid, at.by_positions }),
                 limit = std::min(percent_ / 3, greatest);
    bool refined = false;
    const auto ask = [&](const double part, bool (AccuracyTarget::*finer)()) {
      if (part >= limit && (this->*finer)())
        refined = true;
    };
    ask(at.by_bodies, &AccuracyTarget::refine_level);
    ask(at.by_grid, &AccuracyTarget::refine_grid);
    ask(at.by_positions, &AccuracyTarget::refine_positions);
    // What cannot be had where the error comes from may be saved elsewhere.
    return refined || refine_level() || refine_grid() || refine_positions();
  }

  bool AccuracyTarget::refine(const WholeRun &run, const SharedWork &work)
  {
    const ParallelSession *session = work.session();
    const Steps before = now_;
    std::vector<char> decided(4, 0);
    const Stated at = work.rank() == 0 ? stated(run) : Stated();
    if (work.rank() == 0 && stopped_.empty())
      stopped_ = out_of_reach(at);
    if (work.rank() == 0 && stopped_.empty() && refine_most(at))
      try
        {
          require_memory_of(estimate_cost(read_parallel_axis(now()), session ? session->ranks() : 1),
                            session ? session->ranks_on_node() : 1);
          decided = { 1, static_cast<char>(now_.level), static_cast<char>(now_.grid),
                      static_cast<char>(now_.positions) };
        }
      catch (const InputError &error)
        {
          stopped_ = error.what();
        }
    if (session)
      session->broadcast(decided);
    now_ = before;
    if (!decided[0])
      return false;
    before_ = before;
    now_ = { static_cast<std::size_t>(decided[1]), decided[2], decided[3] };
    return true;
  }

  bool AccuracyTarget::go_back(const std::string &why)
  {
    if (!before_)
      return false;
    now_ = *std::exchange(before_, std::nullopt);
    stopped_ = why;
    return true;
  }

  std::string AccuracyTarget::describe(const WholeRun &run) const
  {
    if (percent_ == 0)
      return {};
    const double mean = stated(run).mean;
    return fmt::format(
        "accuracy: {:.4g} % of the mean transmission error was asked for, {} is stated: {} level{}, {} "
        "by {} cells, {} positions{}",
        percent_, std::isinf(mean) ? "nothing" : fmt::format("{:.2g} %", mean), run.input.level,
        now_.level < accuracy_levels().size()
            ? ""
            : fmt::format(" with elements of degree {}", run.input.pinion_mesh.degree),
        run.input.grid.slices, run.input.grid.profile_cells, run.input.positions,
        stopped_.empty() ? "" : "; nothing finer: " + stopped_);
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
      throw StudyRefused(
          file.place(key) +
          "is of runs: the variants of a study have one level, accuracy = \"standard\" for instance");
  }

  std::string levels_report(const CaseFile &file, const int processes)
  {
    const bool has_kinks = turns_suddenly(read_parallel_axis(file).deviations);
    std::string report = fmt::format(
        "Levels of accuracy: time, and errors as they were (median, in % of each quantity; draft and "
        "standard over {} scenes of 16 positions, which peak-to-peak feels most, reference on two examples "
        "at the same positions; the results state their own{})\n"
        "              time     mean TE   p-p TE       A1   pressure   root stress\n",
        scenes_of_expected_errors, has_kinks ? "; of pressure away from the kinks of this flank" : "");
    for (const AccuracyLevel &level : accuracy_levels())
      {
        const CostEstimate cost = estimate_cost(
            read_parallel_axis(file.with({ "accuracy=" + level.name }, file.file())), processes);
        report += fmt::format("  {:<10} {:>6} s {:>11} {:>8} {:>8} {:>10} {:>13}\n", level.name,
                              two_digits(cost.seconds()), level.expected.mean_te, level.expected.peak_to_peak,
                              level.expected.a1, level.expected.pressure, level.expected.root_stress);
      }
    return report;
  }
} // namespace flank
