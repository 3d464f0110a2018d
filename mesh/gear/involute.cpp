// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/involute.hpp"

#include "mesh/base/errors.hpp"

namespace flank
{
  InvoluteHelicoid::InvoluteHelicoid(const double base_radius, const double half_angle_at_base,
                                     const double base_helix_angle)
      : base_radius_(base_radius)
      , half_angle_at_base_(half_angle_at_base)
      , base_helix_angle_(base_helix_angle)
      , twist_(std::tan(base_helix_angle) / base_radius)
      , cos_(std::cos(base_helix_angle))
      , sin_(std::sin(base_helix_angle))
  {
    FLANK_ASSERT(base_radius > 0 && base_helix_angle >= 0, "");
  }

  FlankFrame InvoluteHelicoid::frame(const double roll, const double z) const
  {
    const double sigma = half_angle_at_base_ + twist_ * z - roll; // angle of the base tangent point
    const Eigen::Vector3d radial(std::cos(sigma), std::sin(sigma), 0),
        tangential(-std::sin(sigma), std::cos(sigma), 0);
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    return { base_radius_ * (radial + roll * tangential) + z * axis, radial, sin_ * tangential + cos_ * axis,
             -cos_ * tangential + sin_ * axis };
  }
} // namespace flank
