// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/mesh_cycle.hpp"

#include <map>

namespace flank
{
  /// The contact of one position of the first mesh cycle with its cells, by number of the torque, of those
  /// wanted (above zero): as the run solved it, each with the torques that share its grid. Throws
  /// ComputationError.
  std::map<int, PositionResult> solved_contact(const ParallelAxisCase &input, const LoadedPair &mesh,
                                               int position, const std::vector<int> &torques);

  /// The mesh of a case that keeps its contact cells.
  LoadedPair mesh_with_cells(const ParallelAxisCase                                   &input,
                             const std::vector<std::shared_ptr<const BodyCompliance>> &bodies);
} // namespace flank
