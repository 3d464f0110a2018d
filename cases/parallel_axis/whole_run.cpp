// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/whole_run.hpp"

namespace flank
{
  WholeRun run_with_extras(const ParallelAxisCase &input, const SharedWork &work, const ResultFolder &folder)
  {
    Kept kept;
    for (const auto &extra : input.extras)
      extra->keep(input, kept);
    WholeRun run{ run_parallel_axis(input, work, kept), {} };
    LoadedBodies bodies(run.results.bodies, input.body);
    for (const auto &extra : input.extras)
      {
        StageClock clock;
        run.extras.push_back(extra->compute({ input, run.results.at, bodies, work, folder }));
        clock.finished(extra->name());
        if (clock.stages().back().second >= 0.005) // what positions keep costs nothing here
          run.results.stage_seconds.push_back(clock.stages().back());
      }
    return run;
  }
} // namespace flank
