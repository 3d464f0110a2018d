// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scene/scene.hpp"
#include "cases/roller_pair/keys.hpp"
#include "cases/roller_pair/plan.hpp"
#include "cases/roller_pair/results.hpp"
#include "cases/roller_pair/study.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/stage_clock.hpp"
#include "solver/parallel_session.hpp"

#include <spdlog/spdlog.h>

namespace flank
{
  namespace
  {
    std::string run(const CaseFile &file, RunContext &context)
    {
      const RollerPairCase input = read_roller_pair(file);
      require_memory(bytes_needed(input), context.session.ranks_on_node(), "this run",
                     "lower roller_grid.cells_across or cells_along");
      return context.with_folder(file.inputs(), file.files(), [&](Journal &) {
        if (context.session.rank() > 0)
          return std::string(); // a second on one process: nothing to share out
        StageClock clock;
        const RollerPairRun run = run_roller_pair(input);
        clock.finished("contact");
        for (const std::string &failure : run.failures)
          spdlog::error("failed: {}", failure);
        write_results(context.folder, file, input, run, clock.stages(), context.versions);
        context.failures = run.failures;
        context.folder.finish(run.failures);
        return summary(input, run);
      });
    }
  } // namespace

  /// Two crowned cylinders pressed together, Hertz's formulas beside them. The smallest scene: the one to
  /// copy for a new kind of drive.
  Scene roller_pair_scene()
  {
    return {
      .keys = roller_pair_keys(),
      .result_files = { "contact.csv" },
      .check = [](const CaseFile &file) { return roller_pair_report(read_roller_pair(file)); },
      .plan = [](const CaseFile &file, int) { return plan_report(read_roller_pair(file)); },
      .run = run,
      .study = roller_pair_study,
    };
  }
} // namespace flank
