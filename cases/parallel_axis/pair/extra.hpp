// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/parallel_axis/pair/root_stresses.hpp"
#include "cases/parallel_axis/pair/stated_errors.hpp"
#include "cases/results/result_table.hpp"
#include "cases/work/result_folder.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "contact/stress/loaded_bodies.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// What an extra adds to the work of a run, for its plan.
  struct ExtraCost
  {
    int grids = 0;                     ///< contact grids of a position that are solved in addition
    bool inside_bodies = false;        ///< whether a tooth sector of each body is condensed and factored
    double sector_solutions = 0;       ///< solutions inside a tooth sector of each body, sampled and written
    double gigabytes_inside = 0;       ///< of what it keeps of the inside of bodies, beside the sectors
    double seconds = 0, gigabytes = 0; ///< time and memory of other computations, beside the run's bodies
    double reduction_seconds = 0;      ///< part of `seconds` for bodies that other cases may share
  };

  /// What `flank plan` says of an extra.
  struct ExtraPlan
  {
    std::vector<std::string> computed, left_out; ///< lines of the plan
  };

  /// What an extra is computed from.
  struct FinishedRun
  {
    const ParallelAxisCase &input;
    const PositionsOfTorques &at; ///< complete on rank 0; cells that Kept asks for are on every rank
    LoadedBodies &bodies;
    const SharedWork &work;                       ///< with the journal; its ranks share what is computed
    const ResultFolder &folder;                   ///< for what is too large to be handed back
    const std::vector<RootStress> &root_stresses; ///< on rank 0; empty where the case does not ask for them
    const std::vector<ErrorsOfTorque> &errors;    ///< a torque each; empty: not estimated, or not rank 0
  };

  /// A contact pattern that stands in pattern.csv and results.h5.
  struct ContactPattern
  {
    int torque;        ///< number of the torque among the case's
    double share;      ///< the pattern is computed at this share of that torque
    std::string group; ///< in results.h5
    FlankMap pressure;
  };

  /// What an extra gives to the results, on rank 0.
  struct ExtraOutput
  {
    std::string summary = {}; ///< lines of the summary
    std::optional<ResultTable> table = {};
    std::vector<ContactPattern> patterns = {};
    std::vector<ErrorsOfTorque> bounds = {}; ///< a torque each; empty: it is no error estimate
  };

  /// An optional output of a run: what the plan says, what positions must keep for it, its computation and
  /// its table. The keys by which a case asks for it are its ExtraKind's.
  class Extra
  {
  public:
    virtual ~Extra() = default;

    virtual std::string name() const = 0; ///< of its stage in the list of times

    /// Adds to what the positions keep for it.
    virtual void keep(const ParallelAxisCase &, Kept &) const {}
    virtual ExtraPlan plan(const ParallelAxisCase &input) const = 0;
    virtual ExtraCost cost(const ParallelAxisCase &, int /*processes*/) const { return {}; }

    /// Computes the output from a finished run. Collective. Throws ComputationError.
    virtual ExtraOutput compute(const FinishedRun &run) const = 0;
  };
} // namespace flank
