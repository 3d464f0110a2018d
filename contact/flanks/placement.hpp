// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

namespace flank
{
  /// From a body's canonical frame to the user's: pinion axis through the origin, the gear's through (centre
  /// distance, 0). Orthogonal, a mirror image where the body's hand or the sense of drive asks for it.
  struct Placement
  {
    Eigen::Matrix3d turn;
    Eigen::Vector3d offset; ///< [mm]

    Eigen::Vector3d point(const Eigen::Vector3d &x) const { return turn * x + offset; }
    Eigen::Vector3d vector(const Eigen::Vector3d &v) const { return turn * v; }
    Eigen::Matrix3d tensor(const Eigen::Matrix3d &t) const { return turn * t * turn.transpose(); }
  };

  /// Where each body stands at an unloaded mesh position, whose phases are those of MeshPosition.
  Placement pinion_placement(const GearPair &pair, double phase);
  Placement gear_placement(const GearPair &pair, double phase);

  /// Where one of a body's teeth stands: turned by `tooth` pitches about z first.
  Placement of_tooth(const Placement &body, const Gear &gear, int tooth);
} // namespace flank
