// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_result.hpp"

namespace flank
{
  /// Values over a flank: rows by roll angle, columns by face position.
  struct FlankMap
  {
    std::vector<double> roll, z; ///< [rad], user's z [mm]
    Eigen::MatrixXd value;
  };

  /// K_Hbeta: the load per face width is summed over one mesh cycle; its greatest value over its mean (ISO
  /// 6336-1's w_max / w_m of the mesh as a whole). [-]
  double face_load_factor(const GearPair &pair, const std::vector<PositionResult> &cycle, int slices);

  /// The greatest pressure that every place of the pinion's loaded flank sees over one mesh cycle; between
  /// computed positions the contact line is moved on linearly. [MPa]
  FlankMap contact_pattern(const GearPair &pair, const std::vector<PositionResult> &cycle, int slices);

  /// Share of the active flank (roll angles of the active profile by common face width) that a contact
  /// pattern covers.
  double covered_share(const FlankMap &pattern);

  /// Material removed from the pinion's flank, from the gear's, and from both together where they meet (over
  /// the pinion's roll angle). [mm]
  FlankMap pinion_modification(const GearPair &pair, const MeshDeviations &deviations);
  FlankMap gear_modification(const GearPair &pair, const MeshDeviations &deviations);
  FlankMap sum_of_modifications(const GearPair &pair, const MeshDeviations &deviations);
} // namespace flank
