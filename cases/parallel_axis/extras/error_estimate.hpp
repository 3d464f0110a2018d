// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/mesh_cycle.hpp"

namespace flank
{
  /// Of the first mesh cycle of both; the same torques and positions at both levels.
  std::vector<ErrorEstimate> error_estimate(const ParallelAxisCase &input, const ParallelAxisResults &results,
                                            const ParallelAxisResults &at_other_level);
} // namespace flank
