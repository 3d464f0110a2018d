// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/whole_run.hpp"

namespace flank
{
  Kept kept_for_extras(const ParallelAxisCase &input)
  {
    Kept kept;
    for (const auto &extra : input.extras)
      extra->keep(input, kept);
    return kept;
  }

  WholeRun run_with_extras(const ParallelAxisCase &input, const SharedWork &work, const ResultFolder &folder)
  {
    WholeRun run{ run_parallel_axis(input, work, kept_for_extras(input)), {} };
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
