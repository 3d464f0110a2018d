// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// What a run of a case will take on this machine.
  struct CostEstimate
  {
    double cells = 0;         ///< of a grid, the mean of torques and phases
    double start_seconds = 0; ///< loading the libraries, starting the ranks, writing the results
    double reduction_seconds = 0, contact_seconds = 0, field_seconds = 0, extra_seconds = 0, gigabytes = 0;
    std::vector<std::string> with_fields, with_own; ///< names of the extras whose seconds these are
    double seconds() const
    {
      return start_seconds + reduction_seconds + contact_seconds + field_seconds + extra_seconds;
    }
  };

  /// Estimates from counts of operations and of logarithms, whose speeds are measured now. For `processes`
  /// processes of this machine, which share its cores as available_threads() says; the memory is that of the
  /// largest of them.
  CostEstimate estimate_cost(const ParallelAxisCase &input, int processes);

  /// What will be computed, what is left out and why, time and memory: the report of `flank plan`. Computes
  /// nothing else.
  std::string plan_report(const ParallelAxisCase &input, int processes);

  /// The line by which a run says what it will take.
  std::string plan_line(const ParallelAxisCase &input, const CostEstimate &cost);

  /// Memory of the contact grids of a position on all threads of a process. [bytes]
  double contact_bytes(const ParallelAxisCase &input);

  /// Memory of a process that reduces a body, `processes` of them sharing the work. [bytes]
  double bytes_to_reduce(BodyDefinition body, int processes);

  /// Throws InputError where a run would not fit the memory of this machine, with the figures and what to
  /// change.
  void require_memory_of(const CostEstimate &cost, int processes_on_node);
} // namespace flank
