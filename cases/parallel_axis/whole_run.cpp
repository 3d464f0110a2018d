// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/whole_run.hpp"

#include "cases/parallel_axis/extras/extra_kind.hpp"

#include <algorithm>

namespace flank
{
  const ExtraOutput *WholeRun::with_bounds() const
  {
    const auto found =
        std::ranges::find_if(extras, [](const ExtraOutput &extra) { return !extra.bounds.empty(); });
    return found != extras.end() ? &*found : nullptr;
  }

  Kept kept_for_extras(const ParallelAxisCase &input)
  {
    Kept kept;
    for (const auto &extra : input.extras)
      extra->keep(input, kept);
    return kept;
  }

  WholeRun run_with_extras(ParallelAxisCase input, const SharedWork &work, const ResultFolder &folder,
                           const std::function<ParallelAxisCase(const TorquesFailed &)> &without,
                           const std::function<bool(const WholeRun &)> &enough)
  {
    WholeRun run{ .input = std::move(input), .results = {}, .extras = {} };
    run.results = run_parallel_axis(run.input, work, kept_for_extras(run.input));
    if (const auto failures = failures_of(run.results.at, work); !failures.empty())
      {
        run.input = without(TorquesFailed(failures));
        for (auto failed = failures.rbegin(); failed != failures.rend(); ++failed)
          run.results.at.erase(run.results.at.begin() + static_cast<std::ptrdiff_t>(failed->first));
      }
    LoadedBodies bodies(run.results.bodies, run.input.body);
    for (const auto &extra : run.input.extras)
      {
        StageClock clock;
        run.extras.push_back(extra->compute(
            { .input = run.input, .at = run.results.at, .bodies = bodies, .work = work, .folder = folder }));
        clock.finished(extra->name());
        if (clock.stages().back().second >= 0.005) // what positions keep costs nothing here
          run.results.stage_seconds.push_back(clock.stages().back());
        if (extra->name() == error_estimate_name && enough && !enough(run))
          {
            run.whole = false;
            break;
          }
      }
    return run;
  }
} // namespace flank
