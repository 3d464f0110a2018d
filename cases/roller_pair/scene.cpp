// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scene/scene.hpp"
#include "cases/roller_pair/keys.hpp"
#include "cases/roller_pair/plan.hpp"
#include "cases/roller_pair/results.hpp"
#include "cases/roller_pair/study.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/stage_clock.hpp"
#include "solver/parallel_session.hpp"

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
        const std::vector<RollerPairResult> results = run_roller_pair(input);
        clock.finished("contact");
        write_results(context.folder, file, input, results, clock.stages(), context.versions);
        context.folder.finish();
        return summary(input, results);
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
