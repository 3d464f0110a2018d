// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/whole_run.hpp"

#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>

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
    /// To the stage of that name, if there is one.
    void add_stage(const StageClock &clock, ParallelAxisResults &results)
    {
      const auto &[name, seconds] = clock.stages().back();
      auto &stages = results.stage_seconds;
      const auto same = std::ranges::find(stages, name, &std::pair<std::string, double>::first);
      if (same != stages.end())
        same->second += seconds;
      else if (seconds >= 0.005) // what positions keep costs nothing here
        stages.emplace_back(name, seconds);
    }

    /// A run whose positions are solved, which the extras of its case are added to.
    class Extras
    {
    public:
      Extras(WholeRun &run, const SharedWork &work, const ResultFolder &folder)
          : run_(run)
          , work_(work)
          , folder_(folder)
          , bodies_(run.results.bodies, run.input.body)
      {
      }

      /// All that extras have in common: root stresses, where the case asks for them.
      void prepare()
      {
        if (!asks_for_root_stress(run_.input))
          return;
        StageClock clock;
        root_stresses_ = root_stresses(run_.input, run_.results.at, bodies_, work_);
        clock.finished(root_stress_name);
        add_stage(clock, run_.results);
      }

      void add(const Extra &extra)
      {
        StageClock clock;
        run_.extras.push_back(extra.compute({ .input = run_.input,
                                              .at = run_.results.at,
                                              .bodies = bodies_,
                                              .work = work_,
                                              .folder = folder_,
                                              .root_stresses = root_stresses_,
                                              .errors = run_.results.errors }));
        if (const auto &bounds = run_.extras.back().bounds; !bounds.empty())
          run_.results.errors = bounds;
        clock.finished(extra.name());
        add_stage(clock, run_.results);
      }

    private:
      WholeRun &run_;
      const SharedWork &work_;
      const ResultFolder &folder_;
      LoadedBodies bodies_;
      std::vector<RootStress> root_stresses_;
    };
  } // namespace

  WholeRun run_with_extras(ParallelAxisCase input, const SharedWork &work, const ResultFolder &folder,
                           const std::function<ParallelAxisCase(const TorquesFailed &)> &without,
                           const std::function<bool(const WholeRun &)> &enough)
  {
    WholeRun run{ .input = std::move(input), .results = {}, .extras = {} };
    run.results = run_parallel_axis(run.input, work, kept_for_extras(run.input));
    leave_out_failed(run.input, run.results.at, work, without);
    Extras extras(run, work, folder);
    for (const auto &extra : run.input.extras)
      if (enough && extra->name() == error_estimate_name)
        {
          extras.add(*extra); // of all but root stress, which is for a run that is good enough
          run.whole = enough(run);
          if (!run.whole || !asks_for_root_stress(run.input))
            break;
          run.extras.clear();
        }
    if (!run.whole)
      return run;
    extras.prepare();
    for (const auto &extra : run.input.extras | std::views::drop(run.extras.size()))
      extras.add(*extra);
    return run;
  }
} // namespace flank
