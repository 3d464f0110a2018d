// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/scene/scene.hpp"

namespace flank
{
  struct StudyReport
  {
    long variants = 0;
    bool stopped = false; ///< by a signal: the journal is there, the tables are not
    std::string summary;  ///< of rank 0
  };

  /// What one of several independent calls on the same folder does of a study: every count-th piece.
  struct StudyPart
  {
    int number = 0, count = 1; ///< number: 0 .. count - 1
  };

  /// All variants of a case's [[study]] axes, shared out over the ranks piece by piece. Finished pieces go to
  /// a journal in the folder; the tables are made from it in the variants' order, so that they are the same
  /// on any number of ranks and after any number of stops. A variant that fails is recorded with its reason.
  /// A part goes on with what is in the folder and leaves the tables to a call for the whole. Collective.
  /// Throws InputError.
  StudyReport run_study(const CaseFile &file, const Scene &scene, RunContext &context,
                        const StudyPart &part = {});

  /// The plan of a study: what will be computed, what is left out and why, time and memory.
  std::string plan_study(const CaseFile &file, const Scene &scene, int processes);
} // namespace flank
