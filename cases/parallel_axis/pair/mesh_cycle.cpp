// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/mesh_cycle.hpp"

#include "cases/parallel_axis/pair/position_record.hpp"

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
    std::vector<std::vector<int>> bands_with_zero(const std::vector<double> &torques, const int profile_cells)
    {
      auto bands = torque_bands(torques, profile_cells);
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

      std::vector<double> torques_of(const int j) const
      {
        std::vector<double> of_band;
        for (const int i : band(j))
          of_band.push_back(torques[i]);
        return of_band;
      }

      std::string name(const int j) const
      {
        return fmt::format("{}, position {} of {}, {} mesh cycles, torques {} N mm", what, position(j),
                           positions, cycles, fmt::join(torques_of(j), " "));
      }
    };

    const char *const contact_of_run = "contact"; ///< what a run's own positions are called

    /// Torques that no solution was found for, and why: what was said first in the order of the text.
    class Failures
    {
    public:
      void add(const double torque, const std::string &why)
      {
        const std::lock_guard lock(mutex_);
        const auto [at, is_new] = reasons_.try_emplace(torque, why);
        if (!is_new)
          at->second = std::min(at->second, why);
      }

      /// Tells all ranks. Throws TorquesFailed where there is one.
      void share(const SharedWork &work)
      {
        Packer own;
        pack(own);
        for (const std::vector<char> &of_rank : work.gather(own.result))
          {
            Unpacker in(of_rank);
            unpack(in);
          }
        Packer all;
        pack(all);
        if (work.session())
          work.session()->broadcast(all.result);
        Unpacker in(all.result);
        unpack(in);
        if (!reasons_.empty())
          throw TorquesFailed(reasons_);
      }

    private:
      void pack(Packer &out) const
      {
        out.value(static_cast<std::int64_t>(reasons_.size()));
        for (const auto &[torque, why] : reasons_)
          {
            out.value(torque);
            out.values(std::vector<char>(why.begin(), why.end()));
          }
      }

      void unpack(Unpacker &in)
      {
        for (auto n = in.value<std::int64_t>(); n > 0; --n)
          {
            const auto torque = in.value<double>();
            const auto why = in.values<char>();
            add(torque, { why.begin(), why.end() });
          }
      }

      std::mutex mutex_;
      std::map<double, std::string> reasons_;
    };

    /// The results of a band as bytes. Where no grid serves all its torques each is solved by itself; none
    /// where one of them fails even so.
    std::vector<char> solved_band(
        const std::vector<double> &torques, Failures &failures,
        const std::function<std::vector<std::vector<PositionResult>>(const std::vector<double> &)> &solve)
    {
      std::vector<std::vector<PositionResult>> by_cycle;
      try
        {
          by_cycle = solve(torques);
        }
      catch (const ComputationError &)
        {
          bool all = true;
          for (const double torque : torques)
            try
              {
                const auto alone = solve({ torque });
                by_cycle.resize(alone.size());
                for (std::size_t c = 0; c < alone.size(); ++c)
                  by_cycle[c].push_back(alone[c].front());
              }
            catch (const ComputationError &error)
              {
                failures.add(torque, error.what());
                all = false;
              }
          if (!all)
            return {};
        }
      Packer out;
      for (const std::vector<PositionResult> &of_cycle : by_cycle)
        pack(of_cycle, out);
      return std::move(out.result);
    }

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

  TorquesFailed::TorquesFailed(std::map<double, std::string> why)
      : SharedComputationError(why.begin()->second)
      , reasons(std::move(why))
  {
  }

  PositionsOfTorques roll(const LoadedPair &mesh, const std::vector<double> &torques, const int positions,
                          const int cycles, const std::string &what, const SharedWork &work, const Kept &kept)
  {
    std::vector<int> all(static_cast<std::size_t>(cycles));
    std::iota(all.begin(), all.end(), 0);
    const BandJobs of{ torques, positions, cycles, what,
                       bands_with_zero(torques, mesh.bodies.grid.profile_cells) };
    Failures failures;
    SharedWork::Jobs jobs;
    jobs.count = of.count();
    jobs.run = [&](const int j) {
      LoadedPair own = mesh;
      own.subsurface_stress = kept.subsurface_stress;
      own.keep_cells = kept.keep_cells(of.position(j));
      PositionCompliance compliance(mesh.bodies.pinion, mesh.bodies.gear, mesh.bodies.pair.pinion.flank());
      const SlicedPosition position = own.at(of.phase(j));
      return solved_band(of.torques_of(j), failures, [&](const std::vector<double> &some) {
        return own.solve_all(position, some, all, compliance);
      });
    };
    jobs.name = [&](const int j) { return of.name(j); };
    jobs.sound = [&](const int j, const std::vector<char> &bytes) {
      return is_band(bytes, of.torques_of(j), of.phase(j), cycles);
    };
    jobs.done = [&](const int finished, const int all_of_rank) {
      spdlog::info("{}: {} of {} ({} positions by {} torque bands)", what, finished, all_of_rank, positions,
                   of.per_position());
    };
    auto packed = work.run(jobs);
    failures.share(work);
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

  LoadedPair loaded_pair(const ParallelAxisCase &input,
                         const std::vector<std::shared_ptr<const BodyCompliance>> &bodies)
  {
    return { .bodies = { .pair = input.pair,
                         .pinion = *bodies.front(),
                         .gear = *bodies.back(),
                         .grid = input.grid,
                         .pinion_mounting = input.pinion_mounting,
                         .gear_mounting = input.gear_mounting },
             .deviations = input.deviations };
  }

  std::vector<Journal::Record> records_of_position(const ParallelAxisCase &input, const int position,
                                                   const std::vector<std::vector<PositionResult>> &at)
  {
    const BandJobs of{ input.torques, input.positions, input.cycles, contact_of_run,
                       bands_with_zero(input.torques, input.grid.profile_cells) };
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

  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input, const SharedWork &work,
                                        const Kept &kept)
  {
    ParallelAxisResults results;
    StageClock clock;
    spdlog::info("bodies: {}", input.body.describe());
    results.bodies = reduced_bodies(input.bodies(), OperatorCache::of_user(), work.session(), clock);
    results.unknowns_pinion = results.bodies.front()->n_unknowns();
    results.unknowns_gear = results.bodies.back()->n_unknowns();
    results.at = roll(loaded_pair(input, results.bodies), input.torques, input.positions, input.cycles,
                      contact_of_run, work, kept);
    clock.finished("contact");
    results.stage_seconds = clock.stages();
    return results;
  }
} // namespace flank
