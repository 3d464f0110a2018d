// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/shared_memory.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace flank
{
  /// Starts MPI for the life of the object. One per program, in main.
  /// Threads of a rank (parallel_for) are its share of the cores of its node.
  class ParallelSession
  {
  public:
    ParallelSession(int &argc, char **&argv);
    ~ParallelSession();
    ParallelSession(const ParallelSession &) = delete;

    int ranks() const; ///< MPI processes of this run
    int rank() const;
    int ranks_on_node() const;

    /// The bytes that every rank gives, on rank 0 in the order of the ranks; empty on the others. Collective.
    std::vector<std::vector<char>> gather(const std::vector<char> &bytes) const;

    /// Rank 0's bytes on every rank. Collective.
    void broadcast(std::vector<char> &bytes) const;

    /// The bytes of rank `from`, kept once a node and read by all its ranks. Where the node has no room for
    /// shared memory, every rank gets a copy of its own, and one of them says so. Collective.
    SharedBytes share(const SharedBytes &bytes, int from = 0) const;

    /// Sums over all ranks, entry by entry, into rank 0's. Collective.
    void add_to_root(double *values, std::ptrdiff_t count) const;

    /// Returns when every rank has called it. Collective.
    void wait() const;

    /// Whether `here` is true on any rank; every rank gets the answer. Collective.
    bool any(bool here) const;

    /// Ends all ranks at once with an exit code: for what one rank alone has met.
    [[noreturn]] void abort(int exit_code) const;

  private:
    int on_node_ = 1;
  };

  /// Hands out 0, 1, 2, ..., every number to one caller on one of the ranks, so that whoever is ready takes
  /// the next job. Made and ended by all ranks together.
  class SharedCounter
  {
  public:
    explicit SharedCounter(const ParallelSession &session);
    ~SharedCounter();
    SharedCounter(const SharedCounter &) = delete;

    /// Safe to use from several threads.
    long next();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };

  /// Versions of PETSc (with MUMPS) and of MPI, one a line.
  std::string solver_libraries();
} // namespace flank
