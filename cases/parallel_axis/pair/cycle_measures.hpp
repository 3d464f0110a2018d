// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/results/variant.hpp"

#include <vector>

namespace flank
{
  /// Transmission error along the transverse line of action. [um]
  double transmission_error_um(const GearPair &pair, const PositionResult &result);

  /// Transmission error as a rotation of the gear. [arcsec]
  double transmission_error_arcsec(const GearPair &pair, const PositionResult &result);

  /// Transmission error at all positions. [um]
  std::vector<double> errors_over_cycle(const GearPair &pair, const std::vector<PositionResult> &positions);

  double mean_error_um(const GearPair &pair, const std::vector<PositionResult> &positions);

  /// How the transmission error changes with every parameter of the modifications. [um over its unit]
  std::vector<double> transmission_error_um_by_parameter(const GearPair &pair, const PositionResult &result);

  /// The greatest pressures of all positions. [MPa]
  struct GreatestPressures
  {
    double inside = 0, at_edges = 0;
  };
  GreatestPressures greatest_pressures(std::span<const PositionResult> positions);

  std::vector<PositionResult> first_cycle(const ParallelAxisCase &input,
                                          const std::vector<PositionResult> &positions);

  /// What a study keeps of a position.
  StudyPoint study_point(const GearPair &pair, const PositionResult &result);

  /// A run as a study sees a variant: torques and phases, and [position][torque].
  VariantFrame frame_of(const ParallelAxisCase &input);
  std::vector<StudyPoint> study_points(const ParallelAxisCase &input, const ParallelAxisResults &results);

  /// A torque as tables on the screen have it, in N m; light ones with three digits.
  std::string shown_torque(double torque);

  /// The greatest pressure inside the flanks as tables on the screen have it, in MPa; "at edges" where edges
  /// carry all of the load.
  std::string shown_pressure(const std::vector<PositionResult> &positions);

  /// Amplitudes of harmonics below it may be noise: windows and slices follow the contact from one position
  /// to the next. Twice to seven times what 512 positions show above their 128th harmonic (validation/run
  /// extremes noise). te: at all positions. [um]
  double noise_of_harmonics(const std::vector<double> &te);
} // namespace flank
