// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/polygon.hpp"
#include "mesh/gear/involute.hpp"

namespace flank
{
  /// A contact cell as one body sees it: uniform pressure on a polygon of its flank, in the body's canonical
  /// frame.
  struct Patch
  {
    int tooth;       ///< counted counter-clockwise from the reference tooth
    Polygon outline; ///< corners (q = roll^2 [rad^2], z [mm])
    double roll, z;  ///< centre [rad, mm]
    double half_profile,
        half_generator; ///< half-sides of the rectangle of equal area and second moments [mm]

    /// Position of the centre in another patch's tangent frame: along the profile arc, along the generator.
    /// [mm]
    Eigen::Vector2d seen_from(const Patch &other, const InvoluteHelicoid &flank) const
    {
      const double along = (z - other.z) / flank.cos_base_helix(),
                   other_roll = other.roll + along * flank.roll_per_generator();
      return { profile_length(other_roll, roll, flank.base_radius()), along };
    }
  };
} // namespace flank
