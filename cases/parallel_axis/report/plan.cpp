// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/report/plan.hpp"

#include "cases/parallel_axis/body/body_size.hpp"
#include "cases/parallel_axis/body/body_store.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>

#include <chrono>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Floating-point operations a second of one core in a dense factorisation, the kind of work that everything here comes to. [1/s]
    double measured_speed()
    {
      const Eigen::Index    n    = 700;
      const Eigen::MatrixXd half = Eigen::MatrixXd::Identity(n, n) * n + Eigen::MatrixXd::Ones(n, n);
      double                best = 1e300;
      for (int k = 0; k < 4; ++k) // the first one warms up
        {
          const auto                        start = std::chrono::steady_clock::now();
          const Eigen::LLT<Eigen::MatrixXd> factor(half);
          if (factor.info() == Eigen::Success)
            best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
      return n * n * n / 3.0 / best;
    }

    /// Fitted to draft, standard and reference meshes of the helical example (degree 2): operations of one core's speed that each kind
    /// of work comes to, its efficiency included.
    constexpr double condense_quadratic = 1.2e3, condense_cubic = 3.3, ring_factor = 1.3, table_sources = 2.0e9, cell_quadratic = 2.1e3;

    /// Operations to reduce one body: MUMPS' condensation, the ring's harmonics, the near field's tables.
    double reduction_operations(const Gear &gear, const SectorResolution &resolution, const Split split, const int threads)
    {
      const BodySize size = size_of(resolution);
      const double   kept = size.kept(), half = size.cut / 2, p = resolution.degree;
      const double   condense = condense_quadratic * kept * kept + condense_cubic * kept * kept * kept;
      const double   ring =
          (gear.teeth / 2 + 1) * (4.0 / 3 * half * half * half + 4 * half * half * size.flank + 4 * half * size.flank * size.flank);
      const double block  = 3 * std::pow(5 * p - 1, 2) * 3 * p; // free unknowns of a block of 5 x 5 x 3 elements
      const double tables = split == Split::classical ? 0
                                                      : resolution.flank_rows * std::min(resolution.face_layers, 7) *
                                                            (block * block * block / 3 + table_sources * std::pow((5 * p + 1) / 11, 2));
      return condense + (ring_factor * ring + tables) / threads;
    }

    double cells_of(const ParallelAxisCase &input)
    {
      // Measured: eight tenths of slices times pairs in contact; the rest is cut off by the flanks' edges.
      return 0.8 * input.grid.slices * input.grid.profile_cells * std::max(1.0, input.pair.total_contact_ratio());
    }

    BodyRequest request(const ParallelAxisCase &input, const bool pinion)
    {
      const Gear &gear = pinion ? input.pair.pinion : input.pair.gear;
      return { gear,        pinion ? input.pinion_mesh : input.gear_mesh,
               input.body,  teeth_apart(input.pair, gear),
               input.split, input.classical_depth };
    }

    struct Grids
    {
      int bands = 0, light_bands = 0, torques = 0;
    };

    Grids grids_of(const ParallelAxisCase &input)
    {
      Grids grids;
      for (const auto &band : torque_bands(input.torques, input.grid.profile_cells))
        {
          ++grids.bands;
          grids.torques += static_cast<int>(band.size());
        }
      grids.light_bands = input.light_load_pattern ? grids.bands : 0;
      return grids;
    }
  } // namespace

  CostEstimate estimate_cost(const ParallelAxisCase &input, const int processes)
  {
    const double speed   = measured_speed();
    const int    threads = available_threads(), workers = std::max(1, processes * threads);
    CostEstimate cost;
    const bool   identical = input.identical_bodies();
    double       operators = 0, peak = 0;
    for (const bool pinion : { true, false })
      if (pinion || !identical)
        {
          const BodyRequest body = request(input, pinion);
          const BodySize    size = size_of(body.resolution);
          const double      p    = body.resolution.degree;
          operators += 8 * (size.flank * size.flank * (body.max_offset + 1) + 6.4e4 * std::pow(5 * p + 1, 2));
          if (OperatorCache::of_user().holds(operator_key(body)))
            continue;
          cost.reduction_seconds += reduction_operations(body.gear, body.resolution, input.split, threads) / speed;
          peak = std::max(peak, 1e9 * size.gigabytes());
        }
    const Grids  grids = grids_of(input);
    const double cells = cells_of(input), n_grids = 1.0 * input.positions * (grids.bands + grids.light_bands);
    const double active = 0.45 * cells, solves = 1.0 * input.positions * (input.cycles * grids.bands + grids.light_bands);
    cost.contact_seconds =
        (n_grids * cell_quadratic * cells * cells + solves * (6 * active * active * active / 3 + 10 * cells * cells)) / speed / workers;
    cost.gigabytes = 1e-9 * (2.3e8 + std::max(peak, 1.5 * operators + threads * 4 * 8 * cells * cells +
                                                        1.0 * input.positions * grids.torques * (cells * 64 + input.cycles * 3000.0)));
    return cost;
  }

  std::string plan_line(const ParallelAxisCase &input, const int processes)
  {
    const CostEstimate cost  = estimate_cost(input, processes);
    const Grids        grids = grids_of(input);
    return fmt::format(
        "plan: {} positions{} by {} torque bands, about {:.0f} cells each; about {:.2g} s and {:.2g} GB (flank plan says more)",
        input.positions, input.cycles > 1 ? fmt::format(" in {} mesh cycles", input.cycles) : "", grids.bands + grids.light_bands,
        cells_of(input), cost.seconds(), cost.gigabytes);
  }

  std::string plan_report(const ParallelAxisCase &input)
  {
    std::string r         = input.title + "\n\nWill be computed\n";
    const auto  item      = [&](const std::string &what) { r += "  " + what + "\n"; };
    const bool  identical = input.identical_bodies();
    for (const bool pinion : { true, false })
      {
        if (!pinion && identical)
          continue;
        const BodyRequest body = request(input, pinion);
        if (OperatorCache::of_user().holds(operator_key(body)))
          item(fmt::format("{}: nothing, its operator is cached ({})", body.gear.name, OperatorCache::of_user().path(operator_key(body))));
        else
          item(fmt::format("{}: reduction of one tooth sector, about {:.0f} unknowns of degree {}, closed into the ring of {} teeth",
                           body.gear.name, size_of(body.resolution).unknowns, body.resolution.degree, body.gear.teeth));
      }
    const Grids grids = grids_of(input);
    item(fmt::format(
        "contact: {} positions by {} torque bands: {} grids of about {:.0f} cells, each with one compliance that serves {} solution{}",
        input.positions, grids.bands, input.positions * grids.bands, cells_of(input),
        grids.bands > 0 ? fmt::format("{:.1f}", 1.0 * input.cycles * grids.torques / grids.bands) : "0",
        grids.torques * input.cycles > grids.bands ? "s" : ""));
    if (static_cast<int>(input.torques.size()) > grids.torques)
      item("unloaded: the geometric transmission error, no compliance needed");
    if (input.light_load_pattern)
      item(fmt::format("contact pattern at 1 % of the load: {} more grids", input.positions * grids.light_bands));
    r += "Left out\n";
    if (identical)
      item("reduction of the gear: the same body as the pinion, or its mirror image");
    item(fmt::format("all teeth but one of each body: cyclic symmetry; response over more than {} teeth: no tooth pair in reach",
                     teeth_apart(input.pair, input.pair.pinion)));
    if (input.split == Split::projected)
      item("responses below the flank: only the classical split needs them");
    if (input.cycles == 1)
      item("other mesh cycles: every tooth is the same (mesh_cycle.period = \"hunting\" for index errors and runout)");
    if (!input.light_load_pattern)
      item("contact pattern at 1 % of the load: not asked for (output.light_load_pattern)");
    item("the flanks that carry no load");
    item("stress and displacement fields: not asked for");
    const CostEstimate cost = estimate_cost(input, 1);
    r += fmt::format(
        "Expected on this machine, one process of {} threads\n  reduction {:.2g} s, contact {:.2g} s, all {:.2g} s; {:.2g} GB\n",
        available_threads(), cost.reduction_seconds, cost.contact_seconds, cost.seconds(), cost.gigabytes);
    return r;
  }
} // namespace flank
