// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/study_estimates.hpp"

#include "cases/parallel_axis/extras/extras.hpp"
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/parallel_axis/pair/plan.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/journal.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace flank
{
  namespace
  {
    /// A variant with its error estimate and no other optional output.
    ParallelAxisCase with_estimate_alone(const CaseFile &file)
    {
      ParallelAxisCase input = read_parallel_axis(file);
      std::erase_if(input.extras, [](const auto &extra) { return extra->name() != "error estimate"; });
      return input;
    }

    /// Nothing of a variant that has no results at some torque.
    std::optional<ResultTable> estimate_of(const ParallelAxisCase &input, LoadedBodies &bodies,
                                           const SharedWork &work, const ResultFolder &folder)
    {
      const PositionsOfTorques at = contact_of_run(input, bodies.bodies(), work);
      if (!failures_of(at, work).empty())
        return std::nullopt;
      return input.extras.front()->compute({ input, at, bodies, work, folder }).table;
    }
  } // namespace

  bool asks_for_every_estimate(const StudyAxes &axes)
  {
    return axes.variant(0).text("output.error_estimate") == "every_variant";
  }

  std::string whose(const long variant)
  {
    return variant == 0 ? std::string() : fmt::format("variant {}, ", variant);
  }

  ResultTable estimates_of_variants(const StudyAxes &axes, const std::vector<std::vector<long>> &groups,
                                    Journal &journal, const ResultFolder &folder)
  {
    std::vector<std::pair<long, ResultTable>> found;
    for (const std::vector<long> &variants : groups)
      {
        std::optional<LoadedBodies> bodies;
        for (const long variant : variants)
          {
            const ParallelAxisCase input = with_estimate_alone(axes.variant(variant));
            if (!bodies)
              {
                StageClock clock;
                bodies.emplace(reduced_bodies(input.bodies(), OperatorCache::of_user(), nullptr, clock),
                               input.body);
              }
            const SharedWork work(nullptr, &journal, whose(variant));
            if (auto table = estimate_of(input, *bodies, work, folder))
              found.emplace_back(variant, std::move(*table));
          }
      }
    if (found.empty())
      throw ComputationError("no variant has an error estimate");
    std::sort(found.begin(), found.end(),
              [](const auto &one, const auto &other) { return one.first < other.first; });
    ResultTable all = found.front().second.of_variants("error_estimates");
    for (const auto &[variant, table] : found)
      all.add(variant, table);
    return all;
  }

  double cost_of_estimate(const ParallelAxisCase &input)
  {
    ParallelAxisCase alone = input;
    std::erase_if(alone.extras, [](const auto &extra) { return extra->name() != "error estimate"; });
    return alone.extras.empty() ? 0 : 0.25 * estimate_cost(alone, 1).contact_seconds;
  }
} // namespace flank
