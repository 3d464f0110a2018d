// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/whole_run.hpp"

#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace flank
{
  Kept kept_for_extras(const ParallelAxisCase &input)
  {
    Kept kept;
    for (const auto &extra : input.extras)
      extra->keep(input, kept);
    return kept;
  }

  std::vector<std::string> failures_of(const TorquesFailed &failed, const ParallelAxisCase &input)
  {
    std::vector<std::string> failures;
    for (const auto &[torque, why] : failed.reasons)
      failures.push_back(
          fmt::format("{:.6g} N m has no results: {}", input.torques[torque] / units::newton_metre, why));
    return failures;
  }

  ParallelAxisCase without(const TorquesFailed &failed, const CaseFile &file, const ParallelAxisCase &input)
  {
    std::vector<std::string> left_in_file;
    std::vector<double> left;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      if (!failed.reasons.contains(t))
        {
          left.push_back(input.torques[t]);
          left_in_file.push_back(fmt::format("{}", input.torques[t] / units::newton_metre));
        }
    if (left.empty())
      throw failed;
    try
      {
        ParallelAxisCase result = read_parallel_axis(file.with(
            { fmt::format("load.pinion_torque_Nm=[{}]", fmt::join(left_in_file, ", ")) }, file.file()));
        result.torques = left; // to the last bit
        result.failures = failures_of(failed, input);
        return result;
      }
    catch (const InputError &)
      {
        throw failed;
      }
  }

  void leave_out_failed(ParallelAxisCase &input, PositionsOfTorques &at, const SharedWork &work,
                        const std::function<ParallelAxisCase(const TorquesFailed &)> &without)
  {
    const auto failures = failures_of(at, work);
    if (failures.empty())
      return;
    input = without(TorquesFailed(failures));
    for (auto failed = failures.rbegin(); failed != failures.rend(); ++failed)
      at.erase(at.begin() + static_cast<std::ptrdiff_t>(failed->first));
  }

  namespace
  {
    void add_stage(const StageClock &clock, ParallelAxisResults &results)
    {
      if (clock.stages().back().second >= 0.005) // what positions keep costs nothing here
        results.stage_seconds.push_back(clock.stages().back());
    }

    /// Where the case asks for them: before its extras, as the error estimate is of the greatest of them.
    std::vector<RootStress> root_stresses_asked_for(WholeRun &run, LoadedBodies &bodies,
                                                    const SharedWork &work)
    {
      if (!asks_for_root_stress(run.input))
        return {};
      StageClock clock;
      std::vector<RootStress> roots = root_stresses(run.input, run.results.at, bodies, work);
      clock.finished(root_stress_name);
      add_stage(clock, run.results);
      return roots;
    }
  } // namespace

  WholeRun run_with_extras(ParallelAxisCase input, const SharedWork &work, const ResultFolder &folder,
                           const std::function<ParallelAxisCase(const TorquesFailed &)> &without,
                           const std::function<bool(const WholeRun &)> &enough)
  {
    WholeRun run{ .input = std::move(input), .results = {}, .extras = {} };
    run.results = run_parallel_axis(run.input, work, kept_for_extras(run.input));
    leave_out_failed(run.input, run.results.at, work, without);
    LoadedBodies bodies(run.results.bodies, run.input.body);
    const std::vector<RootStress> roots = root_stresses_asked_for(run, bodies, work);
    for (const auto &extra : run.input.extras)
      {
        StageClock clock;
        run.extras.push_back(extra->compute({ .input = run.input,
                                              .at = run.results.at,
                                              .bodies = bodies,
                                              .work = work,
                                              .folder = folder,
                                              .root_stresses = roots,
                                              .errors = run.results.errors }));
        if (const auto &bounds = run.extras.back().bounds; !bounds.empty())
          run.results.errors = bounds;
        clock.finished(extra->name());
        add_stage(clock, run.results);
        if (extra->name() == error_estimate_name && enough && !enough(run))
          {
            run.whole = false;
            break;
          }
      }
    return run;
  }
} // namespace flank
