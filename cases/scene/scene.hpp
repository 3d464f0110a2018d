// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/work/run_context.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace flank
{
  class StudyAxes;
  class StudyWork;

  /// A kind of drive: everything that the program needs to know of it. A new one is a folder under cases/
  /// with a function that makes one of these, and the function's name in scenes.cpp; cases/README.md walks
  /// through it ("A new kind of drive").
  struct Scene
  {
    SceneKeys keys; ///< with the scene's name

    /// Names of the files that a run of it writes, besides those that scenes.cpp names because several
    /// scenes, studies or reports write them.
    std::vector<std::string> result_files;

    std::function<std::string(const CaseFile &)> check;               ///< the report of `flank check`
    std::function<std::string(const CaseFile &, int processes)> plan; ///< the report of `flank plan`

    /// Computes, writes, returns the summary. Called by every rank; the result is rank 0's.
    std::function<std::string(const CaseFile &, RunContext &)> run;

    /// How `flank study` does the variants of a case; the axes outlive it.
    std::function<std::unique_ptr<StudyWork>(const StudyAxes &)> study;
  };
} // namespace flank
