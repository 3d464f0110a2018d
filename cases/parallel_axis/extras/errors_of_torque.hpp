// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/extras/between_positions.hpp"
#include "cases/parallel_axis/extras/pressure_kind.hpp"
#include "cases/parallel_axis/pair/error_bounds.hpp"

#include <array>
#include <limits>
#include <vector>

namespace flank
{
  /// Bounds of what is wrong with the results at one torque; not-a-number where there is none.
  struct ErrorsOfTorque
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    PressureKind kind; ///< of the greatest pressure inside the flanks
    TransmissionErrorBounds te = nothing_known();
    double regular_pressure = unknown; ///< greatest away from kinks and edges; inside the flanks if that is
                                       ///< regular [MPa]
    double pressure = unknown;         ///< of that, relative
    double load_share = unknown;       ///< of a tooth pair
    std::array<double, 2> root_stress = { unknown, unknown }; ///< greatest of pinion and gear, relative
  };

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
