// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/whole_run.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// The search for what is fine enough: a case that asks for an error (accuracy.mean_te_percent) instead of
  /// a level is computed at the coarsest level that is expected to have it; where its error estimate states
  /// more, with a finer mesh, contact grid or more positions, whichever the error comes from. A key that the
  /// case sets itself stays as it is.
  class AccuracyTarget
  {
  public:
    /// Throws InputError where the estimate is switched off, or errors are asked for that none can be below.
    explicit AccuracyTarget(const CaseFile &file);

    /// The case as it is to be computed now: with a level, and with finer settings where refine() made some.
    CaseFile now() const;

    /// What stands before the names of its jobs in the journal, where the records of other tries are too: all
    /// that the settings of this try follow from. Empty without a target.
    std::string before_names_of_try() const;

    /// Throws InputError where no error of this case can be stated: no torque above 0, or keys of it that are
    /// the coarsest there are.
    void require_estimate(const ParallelAxisCase &input) const;

    /// Whether the estimates of this run, rank 0's, state no more than is asked for; true without a target.
    bool reached(const WholeRun &run) const;

    /// Makes finer what the error of this run comes from most. False: there is nothing left to refine, what
    /// is left cannot bring the target, or this machine has not the memory beside what this run holds.
    /// Collective: rank 0 decides.
    bool refine(const WholeRun &run, const SharedWork &work);

    /// After a finer computation that failed: back to the one before, which is the last. False: there is none
    /// before. On all ranks alike.
    bool go_back(const std::string &why);

    /// The line about the target in the summary; empty without a target.
    std::string describe(const WholeRun &run) const;

    /// The line about the target in `flank plan`.
    std::string plan() const;

  private:
    struct Stated
    {
      double mean = 0, by_bodies = 0, by_grid = 0, by_positions = 0; ///< greatest over torques [%]
    };
    static Stated stated(const WholeRun &run);
    bool has_own_grid() const; ///< whether the case gives both keys of the contact grid
    bool refine_most(const Stated &at);
    bool refine_level();
    bool refine_grid();
    bool refine_positions();

    /// What part of the error is above the target and cannot be made smaller; empty: none.
    std::string out_of_reach(const Stated &at) const;

    struct Steps
    {
      std::size_t level = 0; ///< beyond the last: meshes of levels with elements of a higher degree
      int grid = 0, positions = 0;
    };

    const CaseFile file_;
    double percent_ = 0; ///< 0: none
    Steps now_;
    std::optional<Steps> before_; ///< of the computation before this one
    std::string stopped_;         ///< why nothing finer is computed, though there is something to refine
  };

  /// Throws StudyRefused where a case of a study asks for an error: all variants have one level, or the
  /// levels of an axis.
  void refuse_accuracy_target(const CaseFile &file);

  /// Expected time and error of every level of accuracy, a line each: for `flank plan`.
  std::string levels_report(const CaseFile &file, int processes);
} // namespace flank
