// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/plan.hpp"

#include "cases/parallel_axis/pair/extra.hpp"
#include "cases/work/machine_speed.hpp"
#include "contact/flanks/tip_edges.hpp"
#include "contact/matching/body_size.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/elements/flank_block.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace flank
{
  std::string plan_line(const ParallelAxisCase &input, const CostEstimate &cost)
  {
    return fmt::format("plan: {} positions{} by {}, about {:.0f} cells each; about {} s and "
                       "{} GB (flank plan says more)",
                       input.positions,
                       input.cycles > 1 ? fmt::format(" in {} mesh cycles", input.cycles) : "",
                       counted(cost.bands, "torque band"), cost.cells, two_digits(cost.seconds()),
                       two_digits(cost.gigabytes));
  }

  namespace
  {
    using Lines = std::vector<std::string>;

    std::string reduction_line(const BodyDefinition &body)
    {
      const std::string key = operator_key(body);
      if (OperatorCache::of_user().holds(key))
        return fmt::format("{}: nothing, its operator is cached ({})", body.gear.name,
                           OperatorCache::of_user().path(key));
      if (body.model.reduction == BodyModel::Reduction::direct)
        return fmt::format("{}: all teeth meshed and factored at once, as a check", body.gear.name);
      return fmt::format(
          "{}: reduction of {} tooth sector, about {:.0f} unknowns of degree {}{}, closed into the {} of {} "
          "teeth",
          body.gear.name, in_halves(body) ? "half a" : "one",
          size_of(body.resolution).unknowns / (in_halves(body) ? 2 : 1), body.resolution.degree,
          in_halves(body) ? ", twice (symmetric and antisymmetric)" : "",
          body.model.kind == BodyModel::Kind::ring ? "ring" : "segment", teeth_of(body));
    }

    /// How the ends of the flanks count in the near field.
    std::string ends_line(const BodyDefinition &body)
    {
      const auto degrees = [&](const FlankEnd end) { return opening_at(body.gear, end) * 180 / units::pi; };
      const auto [acute, obtuse] = std::minmax({ degrees(FlankEnd::low), degrees(FlankEnd::high) });
      return fmt::format("ends of the flanks near the contact: edges of elastic wedges of {:.1f}{} degrees",
                         acute, obtuse > acute ? fmt::format(" and {:.1f}", obtuse) : "");
    }

    /// How sharp tip edges count there; empty: all are rounded.
    std::string tips_line(const GearPair &pair)
    {
      std::vector<std::string> degrees;
      for (const Gear *gear : { &pair.pinion, &pair.gear })
        if (gear->tip_rounding == 0)
          degrees.push_back(fmt::format("{:.1f}", opening_at_tip(*gear) * 180 / units::pi));
      degrees.erase(std::unique(degrees.begin(), degrees.end()), degrees.end());
      return degrees.empty() ? ""
                             : fmt::format("sharp tip edges near the contact: edges of elastic wedges of {} "
                                           "degrees",
                                           fmt::join(degrees, " and "));
    }

    Lines contact_lines(const ParallelAxisCase &input, const CostEstimate &cost)
    {
      Lines lines = { fmt::format(
          "contact: {} positions by {}: {} of about {:.0f} cells, each with one "
          "compliance "
          "that serves {} {}",
          input.positions, counted(cost.bands, "torque band"), counted(input.positions * cost.bands, "grid"),
          cost.cells,
          cost.bands > 0 ? fmt::format("{:.1f}", 1.0 * input.cycles * cost.torques / cost.bands) : "0",
          cost.torques * input.cycles > cost.bands ? "solutions" : "solution") };
      if (static_cast<int>(input.torques.size()) > cost.torques)
        lines.push_back("unloaded: the geometric transmission error, no compliance needed");
      if (cost.near_ends)
        lines.push_back(ends_line(input.bodies().front()));
      if (input.near_field.split == Split::projected && input.near_field.free_ends && cost.torques > 0)
        if (const std::string tips = tips_line(input.pair); !tips.empty())
          lines.push_back(tips);
      return lines;
    }

    /// Besides what extras leave out.
    Lines left_out_lines(const ParallelAxisCase &input, const CostEstimate &cost,
                         const std::vector<BodyDefinition> &bodies)
    {
      Lines lines;
      if (bodies.size() == 1)
        lines.push_back("reduction of the gear: the same body as the pinion, or its mirror image");
      for (const BodyDefinition &body : bodies)
        if (in_halves(body))
          lines.push_back(
              fmt::format("the other half of the {}: its mid-plane is a plane of symmetry", body.gear.name));
      if (input.body.reduction != BodyModel::Reduction::direct)
        lines.push_back(input.body.kind == BodyModel::Kind::ring
                            ? "all teeth but one of each body: cyclic symmetry"
                            : "all teeth but one of each segment: they are turned copies");
      lines.push_back(fmt::format("response over more than {}: no tooth pair in reach",
                                  counted(bodies.front().max_offset, "tooth", "teeth")));
      if (input.near_field.split == Split::projected)
        lines.push_back("responses below the flank: only the classical split needs them");
      if (input.near_field.split == Split::projected && input.near_field.free_ends && !cost.near_ends)
        lines.push_back("what free ends of the flanks add to the half-space: no contact comes near them");
      if (input.near_field.split == Split::projected && !input.near_field.free_ends)
        lines.push_back("what free ends of the flanks add to the half-space: half_space ends asked for "
                        "(contact.face_ends)");
      if (input.cycles == 1)
        lines.push_back(input.deviations.pinion.differ_by_tooth() || input.deviations.gear.differ_by_tooth()
                            ? "other mesh cycles, in which other teeth meet: not asked for "
                              "(mesh_cycle.period = \"hunting\")"
                            : "other mesh cycles: every tooth is the same");
      lines.push_back("the flanks that carry no load");
      return lines;
    }

    std::string expected_lines(const CostEstimate &cost, const int processes)
    {
      std::string r = fmt::format(
          "Expected on this machine, {} of {}\n  reduction {} s, contact {} s{}, all {} s; "
          "{} "
          "GB a process\n",
          counted(processes, "process", "processes"), counted(available_threads(), "thread"),
          two_digits(cost.reduction_seconds), two_digits(cost.contact_seconds),
          (cost.field_seconds > 0 ? fmt::format(", {} {} s", fmt::join(cost.with_fields, " and "),
                                                two_digits(cost.field_seconds))
                                  : "") +
              (cost.extra_seconds > 0 ? fmt::format(", {} {} s", fmt::join(cost.with_own, " and "),
                                                    two_digits(cost.extra_seconds))
                                      : ""),
          two_digits(cost.seconds()), two_digits(cost.gigabytes));
      const MemoryLimit limit = available_memory(processes);
      if (1e9 * cost.gigabytes > limit.bytes)
        r += fmt::format("  more than the {} GB that are {}: flank run refuses it\n",
                         two_digits(1e-9 * limit.bytes), limit.by);
      return r;
    }
  } // namespace

  std::string plan_report(const ParallelAxisCase &input, const int processes)
  {
    const CostEstimate cost = estimate_cost(input, processes);
    const auto bodies = planned_requests(input, processes);
    Lines computed, left_out = left_out_lines(input, cost, bodies);
    const auto append = [](Lines &to, const Lines &lines) {
      to.insert(to.end(), lines.begin(), lines.end());
    };
    for (const BodyDefinition &body : bodies)
      computed.push_back(reduction_line(body));
    append(computed, contact_lines(input, cost));
    for (const auto &extra : input.extras)
      {
        const ExtraPlan plan = extra->plan(input);
        append(computed, plan.computed);
        append(left_out, plan.left_out);
      }
    append(left_out, input.not_asked_for);
    std::string r = input.title + "\n\nWill be computed\n";
    for (const std::string &line : computed)
      r += "  " + line + "\n";
    r += "Left out\n";
    for (const std::string &line : left_out)
      r += "  " + line + "\n";
    return r + expected_lines(cost, processes);
  }
} // namespace flank
