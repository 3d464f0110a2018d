// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_grid.hpp"

#include <Eigen/Core>

namespace flank
{
  /// What the pressure comes to near a sharp edge: intensity times the distance from it to the power. 0: none
  /// carries.
  struct EdgeIntensity
  {
    double intensity = 0, power = 0; ///< [MPa mm^-power], [-]
  };

  /// At the sharp face end that carries the greatest pressure of such ends, away from tip edges: of the mean
  /// over a cell there.
  EdgeIntensity intensity_at_ends(const PositionGrid &grid, const Eigen::VectorXd &pressure);

  /// At the sharp tip edges of each slice, of the mean over its cells that such an edge bounds: the distance
  /// counted along the profile, its power's mean over the cells exact.
  std::vector<EdgeIntensity> intensities_at_tips(const GearPair &pair, const PositionGrid &grid,
                                                 const Eigen::VectorXd &force);
} // namespace flank
