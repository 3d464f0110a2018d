// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scene/scene.hpp"
#include "cases/parallel_axis/accuracy_target.hpp"
#include "cases/parallel_axis/extras/extras.hpp"
#include "cases/parallel_axis/geometry_report.hpp"
#include "cases/parallel_axis/pair/plan.hpp"
#include "cases/parallel_axis/results.hpp"
#include "cases/parallel_axis/study.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/parallel_axis/whole_run.hpp"
#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>

namespace flank
{
  namespace
  {
    std::vector<std::string> result_files_of_pairs()
    {
      std::vector<std::string> names = { "pairs.csv",
                                         "lines.csv",
                                         "pattern.csv",
                                         "modifications.csv",
                                         "sidebands.csv",
                                         "design_torques.csv",
                                         "amplitudes_over_torque.csv" };
      for (const ExtraKind &kind : pair_extras())
        names.insert(names.end(), kind.files.begin(), kind.files.end());
      return names;
    }

    /// Says on rank 0 what a run will take. Throws InputError where this machine has not the memory.
    void announce(const ParallelAxisCase &input, const ParallelSession &session)
    {
      if (session.rank() != 0)
        return;
      const CostEstimate cost = estimate_cost(input, session.ranks());
      spdlog::info(plan_line(input, cost));
      require_memory_of(cost, session.ranks_on_node());
    }

    /// Computes a case, again and again on finer settings until the accuracy target is reached or nothing can
    /// be made finer. `file` becomes the case that was computed last.
    WholeRun compute(CaseFile &file, AccuracyTarget &target, Journal &journal, const RunContext &context)
    {
      for (ParallelAxisCase input = read_parallel_axis(file);; input = read_parallel_axis(file))
        {
          const SharedWork work(&context.session, &journal, target.before_names_of_try());
          bool finer = false;
          try
            {
              WholeRun run = run_with_extras(
                  input, work, context.folder,
                  [&](const TorquesFailed &failed) {
                    for (const std::string &failure : failures_of(failed, input))
                      spdlog::error("failed: {}", failure);
                    return without(failed, file, input);
                  },
                  [&](const WholeRun &so_far) {
                    finer = context.session.any(work.rank() == 0 && !target.reached(so_far)) &&
                            target.refine(so_far, work);
                    return !finer;
                  });
              if (!finer)
                return run;
            }
          catch (const OutputError &)
            {
              throw;
            }
          catch (const std::exception &error) // a computation, a library, too little memory
            {
              const bool of_all =
                  context.session.ranks() == 1 || dynamic_cast<const SharedComputationError *>(&error);
              const bool memory = dynamic_cast<const std::bad_alloc *>(&error);
              if (!of_all || !target.go_back(memory ? "out of memory" : error.what()))
                throw;
            }
          file = target.now();
          if (finer && work.rank() == 0)
            {
              const ParallelAxisCase next = read_parallel_axis(file);
              spdlog::info(plan_line(next, estimate_cost(next, context.session.ranks())));
            }
        }
    }

    std::string run(const CaseFile &asked, RunContext &context)
    {
      AccuracyTarget target(asked);
      CaseFile file = target.now();
      const ParallelAxisCase input = read_run(file);
      target.require_estimate(input);
      for (const std::string &warning : input.pair.warnings)
        spdlog::warn("warning: {}", warning);
      announce(input, context.session);
      return context.with_folder(asked.inputs(), asked.files(), [&](Journal &journal) {
        WholeRun whole = compute(file, target, journal, context);
        if (context.session.rank() != 0)
          return std::string();
        if (!target.reached(whole))
          whole.input.failures.push_back(target.describe(whole));
        else if (const std::string reached = target.describe(whole); !reached.empty())
          for (ExtraOutput &extra : whole.extras)
            if (!extra.bounds.empty())
              extra.summary += reached + "\n";
        context.failures = whole.input.failures;
        write_results(context.folder, file, whole.input, whole.results, whole.extras, context.versions);
        context.folder.finish(context.failures);
        return summary(whole.input, whole.results, whole.extras);
      });
    }
  } // namespace

  /// A spur or helical involute pair.
  Scene parallel_axis_scene()
  {
    return { .keys = parallel_axis_keys(),
             .result_files = result_files_of_pairs(),
             .check =
                 [](const CaseFile &file) { return geometry_report(read_run(AccuracyTarget(file).now())); },
             .plan =
                 [](const CaseFile &file, const int processes) {
                   const AccuracyTarget target(file);
                   return plan_report(read_run(target.now()), processes) + target.plan() +
                          levels_report(file, processes);
                 },
             .run = run,
             .study = parallel_axis_study };
  }
} // namespace flank
