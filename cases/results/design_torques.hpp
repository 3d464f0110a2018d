// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/results/design_bounds.hpp"
#include "cases/results/result_table.hpp"
#include "cases/results/transmission_error_curve.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// Whether design torques can be looked for: at least two of the torques are loaded.
  bool has_design_torques(const VariantFrame &frame);

  /// The design torques of a run: every local minimum of A1 (where the positions make whole periods) and of
  /// peak-to-peak transmission error inside its range of torques, by TransmissionErrorCurve. With bounds of
  /// the least values by BoundsOverTorque, where `bounds` is given: of the loads, none where not estimated.
  ResultTable design_torques(const VariantFrame &frame, const std::vector<StudyPoint> &points,
                             const std::optional<std::vector<DesignBounds>> &bounds,
                             const std::string &heading);

  /// amplitudes_over_torque.csv of a run: A1, A2 and peak-to-peak transmission error from the least loaded
  /// torque to the greatest, at the computed torques and between them, by TransmissionErrorCurve; with
  /// `bounds` as design_torques(). Empty unless has_design_torques() and the positions make whole periods.
  ResultTable amplitudes_over_torque(const VariantFrame &frame, const std::vector<StudyPoint> &points,
                                     const std::optional<std::vector<DesignBounds>> &bounds,
                                     const std::string &heading);

  /// The line of the summary that tells the design torques; empty unless has_design_torques().
  std::string design_torque_line(const VariantFrame &frame, const std::vector<StudyPoint> &points);
} // namespace flank
