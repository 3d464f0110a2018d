// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/journal.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flank
{
  class ParallelSession;

  /// Shares independent jobs out over the ranks of a run and the threads of each, and keeps what is done in a
  /// journal. Which rank or thread runs which job does not matter to the result.
  class SharedWork
  {
  public:
    /// Both may be null. Without a session this process works alone, whatever others do; without a journal
    /// nothing is kept. `whose` stands before the jobs' names in the journal, where other cases keep theirs
    /// too.
    SharedWork(const ParallelSession *session, Journal *journal, std::string whose = {});

    int rank() const;
    int ranks() const;

    /// ParallelSession::gather() of the ranks that share the work. Collective.
    std::vector<std::vector<char>> gather(const std::vector<char> &bytes) const;

    /// Returns when every rank has called it. Collective.
    void wait() const;

    struct Jobs
    {
      int count = 0;

      std::function<std::string(int)> name;      ///< which job it is, in words: how the journal knows it
      std::function<std::vector<char>(int)> run; ///< its result
      std::function<bool(int, const std::vector<char> &result)>
          sound;                                      ///< whether what the journal holds can be its result
      std::function<void(int finished, int of)> done; ///< called as this rank's jobs end
    };

    /// Results of all jobs, in their order, on rank 0 (empty on the others). Jobs found in the journal, and
    /// sound, are not run again. Collective.
    std::vector<std::vector<char>> run(const Jobs &jobs) const;

    const ParallelSession *session() const { return session_; }

  private:
    const ParallelSession *session_;
    Journal *journal_;
    std::string whose_;
  };
} // namespace flank
