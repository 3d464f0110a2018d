// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/mesh_cycle.hpp"

#include "cases/parallel_axis/body_store.hpp"

#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>

namespace flank
{
  namespace
  {
    double seconds()
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    /// All torques at all positions of `cycles` mesh cycles: at[torque][cycle * positions + position]. A phase's compliance
    /// serves every cycle.
    void roll(const LoadedMesh &mesh, const std::vector<double> &torques, const int positions, const int cycles, const char *what,
              std::vector<std::vector<PositionResult>> &at)
    {
      at.assign(torques.size(), std::vector<PositionResult>(static_cast<std::size_t>(positions) * cycles));
      std::vector<int> all(cycles);
      std::iota(all.begin(), all.end(), 0);
      const auto       bands = torque_bands(torques, mesh.bodies.grid.profile_cells);
      const int        jobs  = positions * static_cast<int>(bands.size());
      std::atomic<int> done{ 0 };
      if (!bands.empty())
        parallel_for(jobs, [&](const int job) {
          const int           position = job / static_cast<int>(bands.size());
          const auto         &band     = bands[job % bands.size()];
          std::vector<double> of_band;
          for (const int i : band)
            of_band.push_back(torques[i]);
          auto solved = mesh.solve(static_cast<double>(position) / positions, of_band, all);
          for (const int cycle : all)
            for (std::size_t i = 0; i < band.size(); ++i)
              at[band[i]][cycle * positions + position] = std::move(solved[cycle][i]);
          spdlog::info("{}: {} of {} (position {} of {}, band {} of {})", what, ++done, jobs, position + 1, positions,
                       job % bands.size() + 1, bands.size());
        });
      for (std::size_t t = 0; t < torques.size(); ++t)
        if (torques[t] == 0)
          parallel_for(positions, [&](const int position) {
            for (const int cycle : all)
              at[t][cycle * positions + position] = mesh.unloaded(static_cast<double>(position) / positions, cycle);
          });
    }
  } // namespace

  double transmission_error_um(const GearPair &pair, const PositionResult &result)
  {
    return pair.pinion.base_radius * result.theta / units::micrometre;
  }

  double mesh_stiffness(const GearPair &pair, const PositionResult &result)
  {
    return result.stiffness / (pair.pinion.base_radius * pair.pinion.base_radius) / units::newton_per_micrometre;
  }

  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input)
  {
    ParallelAxisResults results;
    double              mark  = seconds();
    const auto          stage = [&](const std::string &name) {
      results.stage_seconds.emplace_back(name, seconds() - mark);
      mark = seconds();
    };
    // Tooth pairs in reach of each other: one more than the contact ratio on either side.
    const int  apart = static_cast<int>(std::ceil(input.pair.total_contact_ratio())) + 2;
    const auto body = [&](const Gear &gear, const SectorResolution &mesh, const std::string &name) {
      bool cached = false;
      spdlog::info("reducing the {}: one tooth sector, closed into the ring", name);
      auto result = reduced_body({ gear, mesh, std::min(apart, gear.teeth / 2), input.split, input.classical_depth }, OperatorCache::of_user(), cached);
      stage(fmt::format("{} of the {}", cached ? "cached operator" : "reduction", name));
      return result;
    };
    const bool identical = input.identical_bodies();
    const auto pinion    = body(input.pair.pinion, input.pinion_mesh, identical ? "pinion (the gear is the same body)" : "pinion");
    const auto gear      = identical ? pinion : body(input.pair.gear, input.gear_mesh, "gear");
    results.unknowns_pinion = pinion->n_unknowns();
    results.unknowns_gear   = gear->n_unknowns();

    const LoadedMesh mesh{ { input.pair, *pinion, *gear, input.grid, input.pinion_mounting, input.gear_mounting }, input.deviations };
    roll(mesh, input.torques, input.positions, input.cycles, "contact", results.at);
    stage("contact");
    if (input.light_load_pattern)
      {
        std::vector<double> light = input.torques;
        for (double &torque : light)
          torque *= 0.01;
        roll(mesh, light, input.positions, 1, "contact at 1 % of the load", results.light);
        stage("contact at 1 % of the load");
      }
    return results;
  }
} // namespace flank
