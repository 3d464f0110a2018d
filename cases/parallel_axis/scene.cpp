// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/scene.hpp"

#include "cases/parallel_axis/extras/error_estimate.hpp"
#include "cases/parallel_axis/extras/field_files.hpp"
#include "cases/parallel_axis/extras/root_stress.hpp"
#include "cases/parallel_axis/geometry_report.hpp"
#include "cases/parallel_axis/input/input.hpp"
#include "cases/parallel_axis/input/keys.hpp"
#include "cases/parallel_axis/plan.hpp"
#include "cases/parallel_axis/results.hpp"
#include "cases/parallel_axis/study.hpp"
#include "solver/parallel_session.hpp"

#include <spdlog/spdlog.h>

namespace flank
{
  Scene parallel_axis_scene()
  {
    return { parallel_axis_keys(),
             { "pairs.csv", "lines.csv", "pattern.csv", "modifications.csv", "subsurface.csv",
               "root_stress.csv", "error_estimate.csv", "sidebands.csv" },
             [](const CaseFile &file) { return geometry_report(read_parallel_axis(file)); },
             [](const CaseFile &file, const int processes) {
               return plan_report(read_parallel_axis(file), processes);
             },
             [](const CaseFile &file, RunContext &context) {
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
                 ParallelAxisResults results = run_parallel_axis(input, { &context.session, &journal });
                 LoadedBodies        bodies(results.bodies, input.body);
                 const auto          stage = [&](const char *name, const auto &work) {
                   StageClock clock;
                   work();
                   clock.finished(name);
                   results.stage_seconds.push_back(clock.stages().back());
                 };
                 if (input.root_stress)
                   stage("root stress",
                         [&] { results.root_stress = root_stress(input, bodies, context.session); });
                 if (input.fields.any())
                   stage("fields", [&] { write_fields(input, bodies, context.folder, context.session); });
                 if (input.at_other_level)
                   stage("error estimate", [&] {
                     const ParallelAxisResults other =
                         run_parallel_axis(*input.at_other_level, { &context.session, nullptr });
                     if (rank == 0)
                       results.error_estimate = error_estimate(input, results, other);
                   });
                 if (rank != 0)
                   return std::string();
                 write_results(context.folder, file, input, results, context.versions);
                 context.folder.finish();
                 return summary(input, results);
               });
             },
             parallel_axis_study };
  }
} // namespace flank
