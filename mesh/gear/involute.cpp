// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/involute.hpp"

#include "mesh/base/errors.hpp"

namespace flank
{
  double inverse_involute(const double value)
  {
    FLANK_ASSERT(value >= 0, std::to_string(value));
    // inv = t - atan(t), t = tan(angle); derivative t^2/(1+t^2). Start from the cubic near zero, from t = inv
    // + pi/2 far out: both lie above the root, where t - atan(t) is convex or steep enough for monotone
    // Newton steps.
    double t =
        std::min(std::cbrt(3 * value) * (1 + 0.4 * std::cbrt(value * value)), value + 1.5707963267948966);
    if (value == 0)
      return 0;
    for (int i = 0; i < 60; ++i)
      {
        const double step = (t - std::atan(t) - value) * (1 + t * t) / (t * t);
        t -= step;
        if (std::abs(step) <= 1e-15 * t)
          break;
      }
    return std::atan(t);
  }

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
