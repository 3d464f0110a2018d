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
    int bands = 0, torques = 0; ///< octaves of torque, which have grids of their own, and loaded torques
    double cells = 0;           ///< of a grid, the mean of torques and phases
    bool near_ends = false;     ///< whether contact comes so near to free ends of the flanks that they count
    double start_seconds = 0;   ///< loading the libraries, starting the ranks, writing the results
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

  /// Memory of the contact grids of a position on all threads of a process. [bytes]
  double contact_bytes(const ParallelAxisCase &input);

  /// Memory of a process that reduces a body, `processes` of them sharing the work. [bytes]
  double bytes_to_reduce(BodyDefinition body, int processes);

  /// Throws InputError where a run would not fit the memory of this machine, with the figures and what to
  /// change.
  void require_memory_of(const CostEstimate &cost, int processes_on_node);

  /// The bodies to reduce, each in the way that `reduced_bodies` will take on so many processes.
  std::vector<BodyDefinition> planned_requests(const ParallelAxisCase &input, int processes);

  /// Whether half a sector is reduced, twice: its mid-plane is a plane of symmetry.
  bool in_halves(const BodyDefinition &body);

  /// Teeth that a body's model has: all of a ring, or those of a segment.
  int teeth_of(const BodyDefinition &body);
} // namespace flank
