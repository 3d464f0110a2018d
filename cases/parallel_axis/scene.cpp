// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scene/scene.hpp"
#include "cases/parallel_axis/extras/extras.hpp"
#include "cases/parallel_axis/geometry_report.hpp"
#include "cases/parallel_axis/pair/plan.hpp"
#include "cases/parallel_axis/results.hpp"
#include "cases/parallel_axis/study.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/parallel_axis/whole_run.hpp"
#include "solver/parallel_session.hpp"

#include <spdlog/spdlog.h>

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

    std::string run(const CaseFile &file, RunContext &context)
    {
      const ParallelAxisCase input = read_parallel_axis(file);
      for (const std::string &warning : input.pair.warnings)
        spdlog::warn("warning: {}", warning);
      const int rank = context.session.rank();
      if (rank == 0)
        {
          const CostEstimate cost = estimate_cost(input, context.session.ranks());
          spdlog::info(plan_line(input, cost));
          require_memory_of(cost, context.session.ranks_on_node());
        }
      return context.with_folder(file.inputs(), file.files(), [&](Journal &journal) {
        const auto [results, extras] =
            run_with_extras(input, SharedWork(&context.session, &journal), context.folder);
        if (rank != 0)
          return std::string();
        write_results(context.folder, file, input, results, extras, context.versions);
        context.folder.finish();
        return summary(input, results, extras);
      });
    }
  } // namespace

  /// A spur or helical involute pair.
  Scene parallel_axis_scene()
  {
    return { .keys = parallel_axis_keys(),
             .result_files = result_files_of_pairs(),
             .check = [](const CaseFile &file) { return geometry_report(read_parallel_axis(file)); },
             .plan = [](const CaseFile &file,
                        const int processes) { return plan_report(read_parallel_axis(file), processes); },
             .run = run,
             .study = parallel_axis_study };
  }
} // namespace flank
