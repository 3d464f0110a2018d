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
    bool goes_on =
        false; ///< with what a killed run of the same case left in the folder, or as one of several parts
    std::vector<std::string> failures; ///< set by a run or study: of what was asked for and not found
    std::string process;               ///< part of the journals' names: of a study's part; else empty

    /// Everything between taking the folder and giving it back. `inputs`: all that the results depend on,
    /// line by line; `input_files`: that are read. Makes nothing and returns a summary that says so where the
    /// folder holds these very results already. A ComputationError in `compute` leaves nothing behind, any
    /// other end what was finished before. `compute` returns rank 0's summary. Collective.
    std::string with_folder(const std::string &inputs, const std::vector<std::string> &input_files,
                            const std::function<std::string(Journal &)> &compute);
  };
} // namespace flank
