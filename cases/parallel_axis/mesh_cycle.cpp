// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/mesh_cycle.hpp"

#include "cases/parallel_axis/position_record.hpp"

#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <numeric>

namespace flank
{
  namespace
  {
    /// All torques at all positions of `cycles` mesh cycles: at[torque][cycle * positions + position]. A
    /// phase's compliance serves every cycle.
    void roll(const LoadedPair &mesh, const std::vector<double> &torques, const int positions,
              const int cycles, const char *what, const SharedWork &work,
              std::vector<std::vector<PositionResult>> &at)
    {
      std::vector<int> all(cycles);
      std::iota(all.begin(), all.end(), 0);
      auto       bands   = torque_bands(torques, mesh.bodies.grid.profile_cells);
      const auto n_bands = bands.size(); // and one more for zero torques, which need no compliance
      bands.emplace_back();
      for (std::size_t t = 0; t < torques.size(); ++t)
        if (torques[t] == 0)
          bands.back().push_back(static_cast<int>(t));
      const int per_position = static_cast<int>(n_bands + !bands.back().empty());

      const auto job = [&](const int j) {
        const int    band  = j % per_position;
        const double phase = static_cast<double>(j / per_position) / positions;
        Packer       out;
        if (band == static_cast<int>(n_bands))
          for (const int cycle : all)
            {
              pack(std::vector<PositionResult>(bands[band].size(), mesh.unloaded(phase, cycle)), out);
            }
        else
          {
            std::vector<double> of_band;
            for (const int i : bands[band])
              of_band.push_back(torques[i]);
            for (const auto &of_cycle : mesh.solve(phase, of_band, all))
              pack(of_cycle, out);
          }
        return std::move(out.result);
      };
      const auto torques_of = [&](const int j) {
        std::vector<double> of_band;
        for (const int i : bands[j % per_position])
          of_band.push_back(torques[i]);
        return of_band;
      };
      SharedWork::Jobs jobs;
      jobs.count = positions * per_position;
      jobs.run   = job;
      jobs.name  = [&](const int j) {
        return fmt::format("{}, position {} of {}, {} mesh cycles, torques {} N mm", what, j / per_position,
                            positions, cycles, fmt::join(torques_of(j), " "));
      };
      jobs.sound = [&](const int j, const std::vector<char> &bytes) {
        return is_band(bytes, torques_of(j), static_cast<double>(j / per_position) / positions, cycles);
      };
      jobs.done = [&](const int finished, const int of) {
        spdlog::info("{}: {} of {} ({} positions by {} torque bands)", what, finished, of, positions,
                     per_position);
      };
      const auto packed = work.run(jobs);
      at.assign(torques.size(), std::vector<PositionResult>(static_cast<std::size_t>(positions) * cycles));
      for (std::size_t j = 0; j < packed.size(); ++j)
        {
          Unpacker in(packed[j]);
          for (const int cycle : all)
            {
              std::vector<PositionResult> band = unpack_band(in);
              for (std::size_t t = 0; t < band.size(); ++t)
                at[bands[j % per_position][t]][cycle * positions + static_cast<int>(j) / per_position] =
                    std::move(band[t]);
            }
        }
    }
  } // namespace

  double transmission_error_um(const GearPair &pair, const PositionResult &result)
  {
    return pair.pinion.base_radius * result.theta / units::micrometre;
  }

  double mesh_stiffness(const GearPair &pair, const PositionResult &result)
  {
    return result.stiffness / (pair.pinion.base_radius * pair.pinion.base_radius) /
           units::newton_per_micrometre;
  }

  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input, const SharedWork &work)
  {
    ParallelAxisResults results;
    StageClock          clock;
    spdlog::info("bodies: {}", input.body.describe());
    const auto  bodies = reduced_bodies(input.bodies(), OperatorCache::of_user(), work.session(), clock);
    const auto &pinion = bodies.front(), &gear = bodies.back();
    results.unknowns_pinion = pinion->n_unknowns();
    results.unknowns_gear   = gear->n_unknowns();

    LoadedPair mesh{ { input.pair, *pinion, *gear, input.grid, input.pinion_mounting, input.gear_mounting },
                     input.deviations };
    mesh.subsurface_stress = input.subsurface_stress;
    roll(mesh, input.torques, input.positions, input.cycles, "contact", work, results.at);
    clock.finished("contact");
    if (input.light_load_pattern)
      {
        mesh.subsurface_stress    = false;
        std::vector<double> light = input.torques;
        for (double &torque : light)
          torque *= 0.01;
        roll(mesh, light, input.positions, 1, "contact at 1 % of the load", work, results.light);
        clock.finished("contact at 1 % of the load");
      }
    results.stage_seconds = clock.stages();
    results.bodies        = bodies;
    return results;
  }
} // namespace flank
