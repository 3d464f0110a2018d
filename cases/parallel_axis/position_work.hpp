// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/journal.hpp"

#include <functional>
#include <vector>

namespace flank
{
  class ParallelSession;

  /// Shares independent jobs out over the ranks of a run and the threads of each, and keeps what is done in a journal. Which rank
  /// or thread runs which job does not matter to the result.
  class PositionWork
  {
  public:
    /// Both may be null: one process, nothing kept.
    PositionWork(const ParallelSession *session, Journal *journal);

    bool is_root() const;

    /// Results of jobs 0..count-1 of a stage, in their order, on rank 0 (empty on the others). Jobs found in the journal are
    /// not run again. Collective. `done(finished, of)` is called as this rank's jobs end.
    std::vector<std::vector<char>> run(int stage, int count, const std::function<std::vector<char>(int)> &job,
                                       const std::function<void(int finished, int of)> &done) const;

    const ParallelSession *session() const { return session_; }

  private:
    const ParallelSession *session_;
    Journal               *journal_;
  };
} // namespace flank
