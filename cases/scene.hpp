// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file.hpp"
#include "cases/run_context.hpp"
#include "cases/study/study_work.hpp"

#include <functional>
#include <string>

namespace flank
{
  class StudyAxes;

  /// A kind of drive. A new one is a folder under cases/ that makes one of these, and its keys in the schema.
  struct Scene
  {
    std::string                                                 name;
    std::function<std::string(const CaseFile &)>                check; ///< the report of `flank check`
    std::function<std::string(const CaseFile &, int processes)> plan;  ///< the report of `flank plan`

    /// Computes, writes, returns the summary. Called by every rank; the result is rank 0's.
    std::function<std::string(const CaseFile &, RunContext &)> run;

    /// How `flank study` does the variants of a case; the axes outlive it.
    std::function<std::unique_ptr<StudyWork>(const StudyAxes &)> study;
  };

  Scene parallel_axis_scene();
  Scene double_roller_scene();
} // namespace flank
