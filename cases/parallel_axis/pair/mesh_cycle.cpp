// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/mesh_cycle.hpp"

#include "cases/parallel_axis/pair/position_record.hpp"

#include "mesh/base/counted.hpp"
#include "mesh/base/units.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>

namespace flank
{
  namespace
  {
    /// Torques that share a grid, by their numbers; zero torques, which need no compliance, the last.
    std::vector<std::vector<int>> bands_with_zero(const GearPair &pair, const std::vector<double> &torques)
    {
      auto bands = torque_bands(pair, torques);
      std::vector<int> unloaded;
      for (std::size_t t = 0; t < torques.size(); ++t)
        if (torques[t] == 0)
          unloaded.push_back(static_cast<int>(t));
      if (!unloaded.empty())
        bands.push_back(std::move(unloaded));
      return bands;
    }

    /// What roll() shares out and the journal knows: the torque bands of every position.
    struct BandJobs
    {
      const MeshBodies &bodies;
      const std::vector<double> &torques;
      int positions, cycles;
      std::string what;
      std::vector<std::vector<int>> bands; ///< numbers of torques

      int per_position() const { return static_cast<int>(bands.size()); }
      int count() const { return positions * per_position(); }
      int position(const int j) const { return j / per_position(); }
      double phase(const int j) const { return static_cast<double>(position(j)) / positions; }
      const std::vector<int> &band(const int j) const
      {
        return bands[static_cast<std::size_t>(j % per_position())];
      }

      std::vector<double> torques_of(const int j) const { return torques_of_band(torques, band(j)); }

      std::string name(const int j) const
      {
        return fmt::format("{}, {} by {} cells on bodies of {} and {} unknowns, position {} of {}, {} mesh "
                           "cycles, torques {} N mm",
                           what, bodies.grid.slices, bodies.grid.profile_cells, bodies.pinion.n_unknowns(),
                           bodies.gear.n_unknowns(), position(j), positions, cycles,
                           fmt::join(torques_of(j), " "));
      }
    };

    const char *const own_positions = "contact"; ///< what those of a run are called

    /// The bands of the positions whose cells are kept go from rank 0 to all.
    void share(std::vector<std::vector<char>> &packed, const int jobs, const int per_position,
               const Kept &kept, const ParallelSession *session)
    {
      if (!session || session->ranks() == 1 || kept.cells.empty())
        return;
      packed.resize(static_cast<std::size_t>(jobs));
      for (int j = 0; j < jobs; ++j)
        if (kept.keep_cells(j / per_position))
          session->broadcast(packed[static_cast<std::size_t>(j)]);
    }
  } // namespace

  TorquesFailed::TorquesFailed(std::map<std::size_t, std::string> why)
      : SharedComputationError(why.begin()->second)
      , reasons(std::move(why))
  {
  }

  std::map<std::size_t, std::string> failures_of(const PositionsOfTorques &at, const SharedWork &work)
  {
    std::vector<char> packed;
    if (work.rank() == 0)
      {
        Packer out;
        for (std::size_t t = 0; t < at.size(); ++t)
          if (const auto failed = std::find_if(at[t].begin(), at[t].end(),
                                               [](const PositionResult &r) { return !r.failure.empty(); });
              failed != at[t].end())
            {
              out.value(t);
              out.values(std::vector<char>(failed->failure.begin(), failed->failure.end()));
            }
        packed = std::move(out.result);
      }
    if (work.session())
      work.session()->broadcast(packed);
    std::map<std::size_t, std::string> failures;
    for (Unpacker in(packed); !in.at_end();)
      {
        const auto torque = in.value<std::size_t>();
        const auto why = in.values<char>();
        failures[torque].assign(why.begin(), why.end());
      }
    return failures;
  }

  PositionsOfTorques roll(const LoadedPair &mesh, const std::vector<double> &torques, const int positions,
                          const int cycles, const std::string &what, const SharedWork &work, const Kept &kept)
  {
    std::vector<int> all(static_cast<std::size_t>(cycles));
    std::iota(all.begin(), all.end(), 0);
    const BandJobs of{ .bodies = mesh.bodies,
                       .torques = torques,
                       .positions = positions,
                       .cycles = cycles,
                       .what = what,
                       .bands = bands_with_zero(mesh.bodies.pair, torques) };
    SharedWork::Jobs jobs;
    jobs.count = of.count();
    // Packed on one process too: the journal holds what is packed, and what is read back is what is used.
    jobs.run = [&](const int j) {
      LoadedPair own = mesh;
      own.measures = kept.measures;
      own.conditioning = true;
      own.keep_cells = kept.keep_cells(of.position(j));
      PositionCompliance compliance = own.compliance();
      Packer out;
      for (const auto &of_cycle : own.solve_all(own.at(of.phase(j)), of.torques_of(j), all, compliance))
        pack(of_cycle, out);
      return std::move(out.result);
    };
    jobs.name = [&](const int j) { return of.name(j); };
    jobs.sound = [&](const int j, const std::vector<char> &bytes) {
      return is_band(bytes, of.torques_of(j), of.phase(j), cycles, kept.measures.size());
    };
    jobs.done = [&](const int finished, const int all_of_rank) {
      spdlog::info("{}: {} of {} ({} positions by {})", what, finished, all_of_rank, positions,
                   counted(of.per_position(), "torque band"));
    };
    auto packed = work.run(jobs);
    share(packed, jobs.count, of.per_position(), kept, work.session());
    PositionsOfTorques at(torques.size(),
                          std::vector<PositionResult>(static_cast<std::size_t>(positions) * cycles));
    for (int j = 0; j < static_cast<int>(packed.size()); ++j)
      if (const std::vector<char> &bytes = packed[static_cast<std::size_t>(j)]; !bytes.empty())
        {
          Unpacker in(bytes);
          for (const int cycle : all)
            {
              std::vector<PositionResult> band = unpack_band(in);
              for (std::size_t t = 0; t < band.size(); ++t)
                at[of.band(j)[t]][cycle * positions + of.position(j)] = std::move(band[t]);
            }
        }
    return at;
  }

  namespace
  {
    std::shared_ptr<const CoastFlanks> coast_of(const ParallelAxisCase &input)
    {
      CoastFlanks coast{ .pinion = input.coast.pinion, .gear = input.coast.gear, .cycles = input.cycles };
      const BacklashTaken taken = backlash_taken(input.pair, input.deviations, coast);
      coast.taken_otherwise = taken.by_single_teeth + taken.by_runout;
      return std::make_shared<const CoastFlanks>(std::move(coast));
    }
  } // namespace

  LoadedPair loaded_pair(const ParallelAxisCase &input,
                         const std::vector<std::shared_ptr<const BodyCompliance>> &bodies)
  {
    return { .bodies = { .pair = input.pair,
                         .pinion = *bodies.front(),
                         .gear = *bodies.back(),
                         .grid = input.grid,
                         .pinion_mounting = input.pinion_mounting,
                         .gear_mounting = input.gear_mounting },
             .deviations = input.deviations,
             .coast = input.has_tilt_springs() ? coast_of(input) : nullptr };
  }

  std::vector<Journal::Record> records_of_position(const ParallelAxisCase &input, const MeshBodies &bodies,
                                                   const int position,
                                                   const std::vector<std::vector<PositionResult>> &at)
  {
    const BandJobs of{ .bodies = bodies,
                       .torques = input.torques,
                       .positions = input.positions,
                       .cycles = input.cycles,
                       .what = own_positions,
                       .bands = bands_with_zero(input.pair, input.torques) };
    std::vector<Journal::Record> records;
    for (int j = position * of.per_position(); j < (position + 1) * of.per_position(); ++j)
      {
        Packer out;
        for (const std::vector<PositionResult> &of_cycle : at)
          {
            std::vector<PositionResult> band;
            for (const int t : of.band(j))
              band.push_back(of_cycle[static_cast<std::size_t>(t)]);
            pack(band, out);
          }
        records.push_back({ of.name(j), std::move(out.result) });
      }
    return records;
  }

  PositionsOfTorques contact_of_run(const ParallelAxisCase &input,
                                    const std::vector<std::shared_ptr<const BodyCompliance>> &bodies,
                                    const SharedWork &work, const Kept &kept)
  {
    return roll(loaded_pair(input, bodies), input.torques, input.positions, input.cycles, own_positions, work,
                kept);
  }

  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input, const SharedWork &work,
                                        const Kept &kept)
  {
    ParallelAxisResults results;
    StageClock clock;
    spdlog::info("bodies: {}", input.body.describe());
    results.bodies = reduced_bodies(input.bodies(), OperatorCache::of_user(), work.session(), clock);
    results.unknowns_pinion = results.bodies.front()->n_unknowns();
    results.unknowns_gear = results.bodies.back()->n_unknowns();
    results.at = contact_of_run(input, results.bodies, work, kept);
    clock.finished("contact");
    results.stage_seconds = clock.stages();
    return results;
  }
} // namespace flank
