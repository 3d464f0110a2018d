// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/half_space/half_space.hpp"

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

  /// The greatest stresses at any depth below some surface points [mm], down to `deepest` [mm], under loads
  /// on a half-space: sampled at `samples` depths and refined by Brent's method.
  SubsurfaceStress greatest_below(const std::vector<LoadedRectangle> &loads,
                                  const std::vector<Eigen::Vector2d> &points, double deepest,
                                  double poissons_ratio, int samples = 24);

  /// The same for two bodies pressed together, which differ in Poisson's ratio: the greater of each stress,
  /// with the depth in the body that has it.
  SubsurfaceStress greatest_below_both(const std::vector<LoadedRectangle> &loads,
                                       const std::vector<Eigen::Vector2d> &points, double deepest,
                                       double first_poissons_ratio, double second_poissons_ratio);
} // namespace flank::half_space
