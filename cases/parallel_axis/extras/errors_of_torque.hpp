// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/extras/between_positions.hpp"
#include "cases/parallel_axis/extras/pressure_kind.hpp"
#include "cases/parallel_axis/pair/stated_errors.hpp"

#include <vector>

namespace flank
{
  /// What the coarser computations of one torque say at one sampled position.
  struct CoarserSample
  {
    const PositionResult &fine, &coarse_grid, &coarse_all;
  };

  /// Bounds of the errors at one torque, without root stress, from all its positions, the coarser ones at
  /// some of them and those halfway.
  ErrorsOfTorque errors_of_torque(const ParallelAxisCase &input, const std::vector<PositionResult> &at,
                                  const std::vector<CoarserSample> &samples, const Halves &halves);
} // namespace flank
