// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "cases/parallel_axis/pair/stated_errors.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/shared_work.hpp"
#include "contact/loaded/loaded_pair.hpp"
#include "mesh/base/errors.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace flank
{
  /// What positions keep for extras, besides transmission error, pressures and loads.
  struct Kept
  {
    std::map<std::string, SolutionMeasure> measures; ///< of every solution, by the extra's name
    std::set<int> cells; ///< positions of the first mesh cycle whose contact cells are kept: on every rank
    bool keep_cells(const int position) const { return cells.contains(position); }
  };

  /// Thrown by every rank where no solution was found at some torques, even if the others have one.
  struct TorquesFailed : SharedComputationError
  {
    explicit TorquesFailed(std::map<std::size_t, std::string> why);
    std::map<std::size_t, std::string> reasons; ///< by number of the torque
  };

  using PositionsOfTorques = std::vector<std::vector<PositionResult>>; ///< [torque][position]

  /// Everything one run found.
  struct ParallelAxisResults
  {
    PositionsOfTorques at; ///< positions of all mesh cycles in their order
    std::vector<std::pair<std::string, double>> stage_seconds; ///< names and wall times
    std::vector<std::shared_ptr<const BodyCompliance>>
        bodies; ///< the pinion, then the gear where it is another body; on every rank
    int unknowns_pinion = 0, unknowns_gear = 0;
    std::vector<ErrorsOfTorque> errors = {}; ///< a torque each; empty: not estimated, or not rank 0
  };

  /// The pair of a case on its reduced bodies.
  LoadedPair loaded_pair(const ParallelAxisCase &input,
                         const std::vector<std::shared_ptr<const BodyCompliance>> &bodies);

  /// All torques at all positions of `cycles` mesh cycles, in their order. A phase's compliance serves every
  /// cycle. `what`: for messages and the journal. Complete on rank 0 only, but for the first mesh cycle's
  /// positions with cells. Torques without a solution somewhere are told by failures_of(). Collective.
  PositionsOfTorques roll(const LoadedPair &mesh, const std::vector<double> &torques, int positions,
                          int cycles, const std::string &what, const SharedWork &work, const Kept &kept = {});

  /// Numbers of the torques for which a position of rank 0 has no solution, and why the first one has not; on
  /// every rank. Collective.
  std::map<std::size_t, std::string> failures_of(const PositionsOfTorques &at, const SharedWork &work);

  /// All positions of a run on reduced bodies, as far as the journal of `work` does not hold them.
  /// Collective.
  PositionsOfTorques contact_of_run(const ParallelAxisCase &input,
                                    const std::vector<std::shared_ptr<const BodyCompliance>> &bodies,
                                    const SharedWork &work, const Kept &kept = {});

  /// A position solved at all torques in all mesh cycles, [cycle][torque], as the journal of
  /// contact_of_run() has it: a run that finds it there does not solve it again.
  std::vector<Journal::Record> records_of_position(const ParallelAxisCase &input, const MeshBodies &bodies,
                                                   int position,
                                                   const std::vector<std::vector<PositionResult>> &at);

  /// Reduces the bodies (one of them where they are the same) and rolls through the mesh cycle. Complete on
  /// rank 0 only, as roll(). Throws ComputationError.
  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input, const SharedWork &work,
                                        const Kept &kept = {});
} // namespace flank
