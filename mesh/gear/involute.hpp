// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <cmath>

/// The involute helicoid in the body's canonical frame: right-hand helix (or spur), axis z, z = 0 at
/// mid-face, tooth 0 centred on +x at mid-face, the flank on the counter-clockwise side of the tooth. Every
/// other flank of a symmetric tooth is a mirror image of this one.
namespace flank
{
  /// Involute function tan(angle) - angle. [rad]
  inline double involute(const double angle)
  {
    return std::tan(angle) - angle;
  }

  /// Roll angle sqrt((r/r_b)^2 - 1) of the flank point at `radius`. [rad] radius >= base_radius.
  inline double roll_angle(const double radius, const double base_radius)
  {
    const double ratio = radius / base_radius;
    return std::sqrt(std::max(0.0, (ratio - 1.0) * (ratio + 1.0)));
  }

  inline double radius_at_roll(const double roll, const double base_radius)
  {
    return base_radius * std::hypot(1.0, roll);
  }

  /// Length of the transverse profile from one roll angle to another, positive towards the tip:
  /// r_b/2 (to^2 - from^2). [mm]
  inline double profile_length(const double from, const double to, const double base_radius)
  {
    return base_radius / 2 * (to - from) * (to + from);
  }

  /// Roll angle squared at a length along the transverse profile, towards the tip, from where it is q:
  /// q + 2 length/r_b; negative: the profile ends before. [rad^2]
  inline double roll_squared_at(const double q, const double length, const double base_radius)
  {
    return q + 2 * length / base_radius;
  }

  struct FlankFrame
  {
    Eigen::Vector3d origin;    ///< [mm]
    Eigen::Vector3d profile;   ///< unit, transverse profile tangent, towards the tip
    Eigen::Vector3d generator; ///< unit, along the straight generator (the contact line), towards +z
    Eigen::Vector3d inward;    ///< unit, inward normal = profile x generator
  };

  class InvoluteHelicoid
  {
  public:
    /// half_angle_at_base: half the tooth's angle at the base circle [rad]; base_helix_angle >= 0 [rad].
    InvoluteHelicoid(double base_radius, double half_angle_at_base, double base_helix_angle);

    double base_radius() const { return base_radius_; }
    double base_helix_angle() const { return base_helix_angle_; }

    /// Angle by which the transverse section turns per mm along z: tan(beta_b)/r_b. [rad/mm]
    double twist() const { return twist_; }

    /// Half the tooth's angle at a roll angle: psi_b - roll + atan(roll). [rad]
    double half_angle(const double roll) const { return half_angle_at_base_ - roll + std::atan(roll); }

    /// Point and frame of tooth 0's flank at a roll angle and z. A generator keeps its normal: the surface is
    /// developable.
    FlankFrame frame(double roll, double z) const;

    /// Change of roll angle per mm along the generator: sin(beta_b)/r_b. [rad/mm]
    double roll_per_generator() const { return sin_ / base_radius_; }

    /// Roll angle squared at x along the profile, towards the tip, and y along the generator from a point
    /// with this roll angle. [rad^2]
    double roll_squared(const double roll, const double x, const double y) const
    {
      const double on_generator = roll + y * roll_per_generator();
      return roll_squared_at(on_generator * on_generator, x, base_radius_);
    }
    double cos_base_helix() const { return cos_; }
    double sin_base_helix() const { return sin_; }

  private:
    double base_radius_, half_angle_at_base_, base_helix_angle_, twist_, cos_, sin_;
  };
} // namespace flank
