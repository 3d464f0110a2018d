// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair/extra.hpp"

#include <functional>

namespace flank
{
  /// A case computed with all that it asks for.
  struct WholeRun
  {
    ParallelAxisCase input; ///< what was computed: without torques that have no solution
    ParallelAxisResults results;
    std::vector<ExtraOutput> extras; ///< of rank 0, in the order of the case's
    bool whole = true;               ///< false: the errors were too large, and the other extras were left out
  };

  /// What the positions of a case keep for the extras that it asks for.
  Kept kept_for_extras(const ParallelAxisCase &input);

  /// What is said of the torques that failed, a line each.
  std::vector<std::string> failures_of(const TorquesFailed &failed, const ParallelAxisCase &input);

  /// The case without the torques that failed; its `failures` are what is said of them. `file`: what `input`
  /// was read from. Throws `failed` where no torque is left, or where an optional output needs one of them.
  ParallelAxisCase without(const TorquesFailed &failed, const CaseFile &file, const ParallelAxisCase &input);

  /// Takes torques that have no solution out of a case and its positions. `without`: makes the case with
  /// fewer torques. Collective.
  void leave_out_failed(ParallelAxisCase &input, PositionsOfTorques &at, const SharedWork &work,
                        const std::function<ParallelAxisCase(const TorquesFailed &)> &without);

  /// Computes a case and the extras that it asks for. `without`: makes the case with fewer torques, for when
  /// some have no solution. `enough`: asked on every rank when the errors are estimated; if it says no, the
  /// extras after that are left out. What is too large to be handed back goes to the folder. Collective;
  /// complete on rank 0. Throws ComputationError.
  WholeRun run_with_extras(ParallelAxisCase input, const SharedWork &work, const ResultFolder &folder,
                           const std::function<ParallelAxisCase(const TorquesFailed &)> &without,
                           const std::function<bool(const WholeRun &)> &enough = {});
} // namespace flank
