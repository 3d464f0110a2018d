// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/half_space/half_space.hpp"

#include <functional>
#include <vector>

namespace flank::half_space
{
  /// Von Mises stress of a stress tensor.
  double von_mises(const Eigen::Matrix3d &stress);

  struct LoadedRectangle
  {
    Rectangle area; ///< on the surface of the half-space [mm]
    double force;   ///< spread evenly over it, inward [N]
  };

  /// Greatest stresses below a loaded surface and how deep they lie. [MPa, mm]
  struct SubsurfaceStress
  {
    double shear = 0, shear_depth = 0;         ///< half the difference of the outer principal stresses
    double von_mises = 0, von_mises_depth = 0; ///< may lie on the surface
  };

  /// Stress at a depth below a place of the surface (tension positive). [MPa, mm]
  using StressBelow = std::function<Eigen::Matrix3d(const Eigen::Vector2d &at, double depth)>;

  /// That of loads on a half-space, which is kept by reference.
  StressBelow stress_below(const std::vector<LoadedRectangle> &loads, double poissons_ratio);

  /// The greatest stresses at any depth below some surface points [mm], down to `deepest` [mm]: sampled at
  /// `samples` depths and refined by Brent's method.
  SubsurfaceStress greatest_below(const StressBelow &stress, const std::vector<Eigen::Vector2d> &points,
                                  double deepest, int samples = 24);

  /// The greater of each stress of two bodies, with the depth in the body that has it.
  SubsurfaceStress greater_of(const SubsurfaceStress &one, const SubsurfaceStress &other);

  /// greatest_below() of loads on a half-space.
  SubsurfaceStress greatest_below(const std::vector<LoadedRectangle> &loads,
                                  const std::vector<Eigen::Vector2d> &points, double deepest,
                                  double poissons_ratio, int samples = 24);

  /// The same for two bodies pressed together, which differ in Poisson's ratio: greater_of() both.
  SubsurfaceStress greatest_below_both(const std::vector<LoadedRectangle> &loads,
                                       const std::vector<Eigen::Vector2d> &points, double deepest,
                                       double first_poissons_ratio, double second_poissons_ratio);
} // namespace flank::half_space
