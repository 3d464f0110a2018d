// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

#include <cmath>

namespace flank
{
  /// The counter-clockwise half of a tooth's transverse profile, tooth centred on +x, from the tip corner
  /// down: involute, a radial line where the fillet cannot reach the involute, fillet arc, root circle.
  class ToothProfile
  {
  public:
    explicit ToothProfile(const Gear &gear);

    /// Where the involute ends: at the fillet, or at the base circle if a radial line follows. [mm]
    double form_radius() const { return form_radius_; }

    /// Radius of the fillet's upper end: less than form_radius() if a radial line lies between. [mm]
    double fillet_top_radius() const { return fillet_top_radius_; }

    /// Angle at the axis of half the root land, between the fillet's lower end and the middle of the gap.
    /// [rad] < 0: fillets overlap
    double root_land_angle() const { return half_pitch_ - fillet_centre_angle_; }

    /// Angle at the axis between the tooth's middle and the fillet's lower end. [rad]
    double root_angle() const { return fillet_centre_angle_; }

    Eigen::Vector2d involute_point(double roll) const;

    /// Point on the radial line at a radius between fillet_top_radius() and the base radius.
    Eigen::Vector2d radial_line_point(double radius) const;

    /// Fillet arc from its upper end (0) to the root circle (1), equal steps are equal arcs.
    Eigen::Vector2d fillet_point(double fraction) const;

    const Eigen::Vector2d &fillet_centre() const { return fillet_centre_; }

    /// Length of the fillet's arc. [mm]
    double fillet_length() const
    {
      return gear_.fillet_radius * std::abs(fillet_angle_to_ - fillet_angle_from_);
    }

  private:
    Gear gear_;
    double half_pitch_, form_radius_, fillet_top_radius_, fillet_centre_angle_;
    Eigen::Vector2d fillet_centre_;
    double fillet_angle_from_, fillet_angle_to_;
  };

  /// Greatest fillet radius whose arcs do not overlap in the gap, found by bisection. [mm]
  double largest_fillet_radius(const Gear &gear);
} // namespace flank
