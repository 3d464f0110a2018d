// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/coarser_positions.hpp"

#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/pair/position_record.hpp"
#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace flank
{
  namespace
  {
    /// Results that say why there is nothing to compare with.
    std::vector<PositionResult> no_results(const std::vector<double> &torques, const std::string &why)
    {
      PositionResult none;
      none.failure = why;
      return { torques.size(), none };
    }
  } // namespace

  std::map<int, std::vector<int>> halves_wanted(const FinishedRun &run,
                                                const std::function<std::vector<int>(std::size_t)> &places)
  {
    std::map<int, std::vector<int>> halves;
    std::vector<char> packed;
    if (run.work.rank() == 0)
      {
        for (std::size_t t = 0; t < run.at.size() && run.input.cycles == 1; ++t)
          for (const int place : places(t))
            {
              const int twice = 2 * static_cast<int>(run.at[t].size());
              auto &torques = halves[(place + twice) % twice];
              if (torques.empty() || torques.back() != static_cast<int>(t))
                torques.push_back(static_cast<int>(t));
            }
        Packer out;
        for (const auto &[half, torques] : halves)
          out.value(half), out.values(torques);
        packed = std::move(out.result);
      }
    if (run.work.session())
      run.work.session()->broadcast(packed);
    halves.clear();
    for (Unpacker in(packed); !in.at_end();)
      {
        const int half = in.value<int>();
        halves[half] = in.values<int>();
      }
    return halves;
  }

  std::vector<std::vector<PositionResult>> solve_coarser(const std::vector<CoarseJob> &wanted,
                                                         const LoadedPair &own_bodies,
                                                         const LoadedPair &coarse_bodies,
                                                         const std::vector<double> &torques,
                                                         const SharedWork &work)
  {
    const auto torques_of = [&](const int j) {
      std::vector<double> of_job;
      for (const int t : wanted[j].torques)
        of_job.push_back(torques[t]);
      return of_job;
    };
    const std::vector<char> no_solution = { 0 }; // what a job records that has none
    SharedWork::Jobs jobs;
    jobs.count = static_cast<int>(wanted.size());
    jobs.name = [&](const int j) {
      return fmt::format("error estimate, phase {}, coarser grid on {} bodies, torques {} N mm{}",
                         wanted[j].phase, wanted[j].coarse_bodies ? "coarser" : "the same",
                         fmt::join(torques_of(j), " "), wanted[j].keep_cells ? ", with cells" : "");
    };
    jobs.run = [&](const int j) {
      LoadedPair mesh = wanted[j].coarse_bodies ? coarse_bodies : own_bodies;
      mesh.keep_cells = wanted[j].keep_cells;
      Packer out;
      try
        {
          PositionCompliance compliance(mesh.bodies.pinion, mesh.bodies.gear,
                                        mesh.bodies.pair.pinion.flank());
          pack(mesh.solve_all(mesh.at(wanted[j].phase), torques_of(j), { 0 }, compliance).front(), out);
        }
      catch (const ComputationError &)
        {
          return no_solution;
        }
      catch (const std::bad_alloc &) // no record of it counts: who goes on may have the memory
        {
          spdlog::warn("a part of the error estimate is left out: out of memory");
          return std::vector<char>();
        }
      return std::move(out.result);
    };
    jobs.sound = [&](const int j, const std::vector<char> &bytes) {
      return bytes == no_solution || is_band(bytes, torques_of(j), wanted[j].phase, 1);
    };
    jobs.done = [](int, int) {};
    std::vector<std::vector<PositionResult>> results;
    for (const std::vector<char> &bytes : work.run(jobs))
      {
        const std::vector<int> &of_job = wanted[results.size()].torques;
        results.push_back(no_results(torques, "no grid"));
        if (bytes.empty() || bytes == no_solution)
          continue;
        Unpacker in(bytes);
        std::vector<PositionResult> band = unpack_band(in);
        for (std::size_t i = 0; i < of_job.size(); ++i)
          results.back()[of_job[i]] = std::move(band[i]);
      }
    return results;
  }
} // namespace flank
