// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/extra.hpp"

#include "contact/stress/side.hpp"

#include <array>

namespace flank
{
  /// Load times roll angle on its own flank [N rad] of the tooth of a body for which that is greatest: more
  /// load, or load further out. The greatest root stress follows it over a mesh cycle.
  double greatest_bending(const GearPair &pair, const PositionResult &position, Side side);

  /// By how much the greatest tensile root stress of the tooth that is bent most differs on coarser bodies
  /// under the same contact forces, relative: of the pinion, of the gear. `positions`: of one torque;
  /// those with their contact cells count; not-a-number where none is loaded. Throws ComputationError.
  std::array<double, 2> root_stress_differences(const GearPair &pair,
                                                const std::vector<PositionResult> &positions,
                                                LoadedBodies &bodies, LoadedBodies &coarser);
} // namespace flank
