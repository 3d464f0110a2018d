// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/mesh_cycle.hpp"

#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <memory>

namespace flank
{
  namespace
  {
    double seconds()
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
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
    const auto make  = [&](const Gear &gear, const SectorResolution &mesh) {
      return std::make_shared<const BodyCompliance>(gear, mesh, std::min(apart, gear.teeth / 2), input.split, input.classical_depth);
    };
    spdlog::info("reducing the {}: one tooth sector, closed into the ring",
                 input.identical_bodies() ? "pinion (the gear is the same body)" : "pinion");
    const auto pinion = make(input.pair.pinion, input.pinion_mesh);
    stage("reduction of the pinion");
    auto gear = pinion;
    if (!input.identical_bodies())
      {
        spdlog::info("reducing the gear");
        gear = make(input.pair.gear, input.gear_mesh);
        stage("reduction of the gear");
      }
    results.unknowns_pinion = pinion->n_unknowns();
    results.unknowns_gear   = gear->n_unknowns();

    const LoadedMesh mesh{ input.pair, input.pinion_modifications, input.gear_modifications, *pinion, *gear, input.grid };
    const auto       bands = torque_bands(input.torques, input.grid.profile_cells);
    results.at.assign(input.torques.size(), std::vector<PositionResult>(input.positions));
    const int        jobs = input.positions * static_cast<int>(bands.size());
    std::atomic<int> done{ 0 };
    if (!bands.empty())
      parallel_for(jobs, [&](const int job) {
        const int           position = job / static_cast<int>(bands.size());
        const auto         &band     = bands[job % bands.size()];
        std::vector<double> torques;
        for (const int i : band)
          torques.push_back(input.torques[i]);
        auto solved = mesh.solve(static_cast<double>(position) / input.positions, torques);
        for (std::size_t i = 0; i < band.size(); ++i)
          results.at[band[i]][position] = std::move(solved[i]);
        spdlog::info("contact: {} of {} (position {} of {}, band {} of {})", ++done, jobs, position + 1, input.positions,
                     job % bands.size() + 1, bands.size());
      });
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      if (input.torques[t] == 0)
        parallel_for(input.positions,
                     [&](const int position) { results.at[t][position] = mesh.unloaded(static_cast<double>(position) / input.positions); });
    stage("contact");
    return results;
  }
} // namespace flank
