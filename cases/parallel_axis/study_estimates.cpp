// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/study_estimates.hpp"

#include "cases/parallel_axis/extras/extras.hpp"
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/parallel_axis/whole_run.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/journal.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

namespace flank
{
  namespace
  {
    /// A variant with its error estimate and no other optional output.
    ParallelAxisCase with_estimate_alone(ParallelAxisCase input)
    {
      std::erase_if(input.extras, [](const auto &extra) { return extra->name() != error_estimate_name; });
      return input;
    }
  } // namespace

  bool asks_for_every_estimate(const StudyAxes &axes)
  {
    return axes.variant(0).text("output.error_estimate") == "every_variant";
  }

  std::string before_names_of(const long variant)
  {
    return variant == 0 ? std::string() : fmt::format("variant {}, ", variant);
  }

  void add_estimates_of_variants(const StudyAxes &axes, const std::vector<std::vector<long>> &groups,
                                 const std::function<bool(long)> &has_failed, Journal &journal,
                                 const ResultFolder &folder, BeyondTables &result)
  {
    std::map<long, ResultTable> found;
    std::map<long, std::vector<DesignBounds>> bounds;
    for (const std::vector<long> &variants : groups)
      {
        std::optional<LoadedBodies> bodies;
        for (const long variant : variants)
          {
            if (has_failed(variant))
              continue;
            const CaseFile file = axes.variant(variant);
            ParallelAxisCase input = with_estimate_alone(read_parallel_axis(file));
            if (!bodies)
              {
                StageClock clock;
                bodies.emplace(reduced_bodies(input.bodies(), OperatorCache::of_user(), nullptr, clock),
                               input.body);
              }
            const SharedWork work(nullptr, &journal, before_names_of(variant));
            PositionsOfTorques at = contact_of_run(input, bodies->bodies(), work);
            leave_out_failed(input, at, work, [&](const TorquesFailed &failed) {
              return with_estimate_alone(without(failed, file, input));
            });
            ExtraOutput estimate = input.extras.front()->compute({ .input = input,
                                                                   .at = at,
                                                                   .bodies = *bodies,
                                                                   .work = work,
                                                                   .folder = folder,
                                                                   .root_stresses = {},
                                                                   .errors = {} });
            bounds[variant] = design_bounds(estimate.bounds);
            found.emplace(variant, std::move(*estimate.table));
          }
      }
    std::optional<ResultTable> all;
    for (const auto &[variant, table] : found)
      {
        if (!all)
          all = table.of_variants("error_estimates");
        all->add(variant, table);
      }
    if (all)
      result.tables.push_back(std::move(*all));
    result.bounds.merge(bounds);
  }

  double seconds_of_estimate(const ParallelAxisCase &input)
  {
    for (const auto &extra : input.extras)
      if (extra->name() == error_estimate_name)
        {
          const ExtraCost cost = extra->cost(input, 1);
          return cost.seconds - cost.reduction_seconds;
        }
    return 0;
  }
} // namespace flank
