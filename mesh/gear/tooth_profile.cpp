// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/tooth_profile.hpp"

#include "mesh/base/units.hpp"

namespace flank
{
  ToothProfile::ToothProfile(const Gear &gear)
      : gear_(gear)
      , half_pitch_(units::pi / gear.teeth)
  {
    const double base = gear.base_radius, rho = gear.fillet_radius, centre_radius = gear.root_radius + rho;

    // The fillet's centre lies rho outside the involute on its normal, which touches the base circle:
    // centre_radius^2 = r_b^2 + (r_b roll + rho)^2.
    const double along_normal =
        centre_radius > base ? std::sqrt((centre_radius - base) * (centre_radius + base)) : 0;
    Eigen::Vector2d top;
    if (along_normal > rho)
      {
        const double roll = (along_normal - rho) / base;
        form_radius_ = radius_at_roll(roll, base);
        fillet_top_radius_ = form_radius_;
        fillet_centre_angle_ = gear.half_angle_at_base - roll + std::atan(along_normal / base);
        top = involute_point(roll);
      }
    else
      {
        form_radius_ = base;
        fillet_top_radius_ = std::sqrt(centre_radius * centre_radius - rho * rho);
        fillet_centre_angle_ = gear.half_angle_at_base + std::asin(rho / centre_radius);
        top = radial_line_point(fillet_top_radius_);
      }
    fillet_centre_ =
        centre_radius * Eigen::Vector2d(std::cos(fillet_centre_angle_), std::sin(fillet_centre_angle_));
    const Eigen::Vector2d to_top = top - fillet_centre_;
    fillet_angle_from_ = std::atan2(to_top.y(), to_top.x());
    fillet_angle_to_ = std::remainder(fillet_centre_angle_ + units::pi - fillet_angle_from_, 2 * units::pi) +
                       fillet_angle_from_;
  }

  Eigen::Vector2d ToothProfile::involute_point(const double roll) const
  {
    const double angle = gear_.half_angle_at_base - roll + std::atan(roll);
    const double radius = radius_at_roll(roll, gear_.base_radius);
    return { radius * std::cos(angle), radius * std::sin(angle) };
  }

  Eigen::Vector2d ToothProfile::radial_line_point(const double radius) const
  {
    return { radius * std::cos(gear_.half_angle_at_base), radius * std::sin(gear_.half_angle_at_base) };
  }

  Eigen::Vector2d ToothProfile::fillet_point(const double fraction) const
  {
    const double angle = fillet_angle_from_ + fraction * (fillet_angle_to_ - fillet_angle_from_);
    return fillet_centre_ + gear_.fillet_radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }

  double largest_fillet_radius(const Gear &gear)
  {
    Gear trial = gear;
    double low = 0, high = gear.fillet_radius;
    for (int i = 0; i < 50; ++i)
      {
        trial.fillet_radius = 0.5 * (low + high);
        (ToothProfile(trial).root_land_angle() >= 0 ? low : high) = trial.fillet_radius;
      }
    return low;
  }
} // namespace flank
