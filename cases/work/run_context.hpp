// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/journal.hpp"
#include "cases/work/result_folder.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flank
{
  class ParallelSession;

  /// What a run or a study works with: its folder, and its journal in it.
  struct RunContext
  {
    ResultFolder &folder;
    const ParallelSession &session;
    std::string versions;
    bool goes_on = false; ///< whether it goes on with what a killed run of the same case left in the folder,
                          ///< or is one of several parts
    std::vector<std::string> failures; ///< set by a run or study: what was asked for and could not be
                                       ///< computed, a line each
    std::string process;               ///< part of the journals' names: of a study's part; else empty

    /// Takes the folder, computes, and gives the folder back. `inputs`: all that the results depend on, line
    /// by line; `input_files`: the files that are read; `compute` returns rank 0's summary. Computes nothing
    /// and returns a summary that says so where the folder holds these very results already. After a
    /// ComputationError in `compute` nothing is left behind; after any other end the pieces of work that were
    /// finished are. Collective.
    std::string with_folder(const std::string &inputs, const std::vector<std::string> &input_files,
                            const std::function<std::string(Journal &)> &compute);
  };
} // namespace flank
