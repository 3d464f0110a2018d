// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <span>

/// The elastic half-space z >= 0 loaded on its surface, z inward, in the patch's own frame.
/// Sources: Boussinesq (1885) point load; Love (1929) rectangle under uniform pressure.
namespace flank::half_space
{
  /// A rectangle of half-lengths a (along x) and b (along y). [mm]
  struct Rectangle
  {
    double x = 0, y = 0, a = 0, b = 0;
    double area() const { return 4 * a * b; }
  };

  /// (1 - nu^2)/(pi E): surface displacement times distance for unit force. [mm^2/N]
  inline double surface_compliance(const double youngs_modulus, const double poissons_ratio)
  {
    return (1 - poissons_ratio * poissons_ratio) / (3.14159265358979323846 * youngs_modulus);
  }

  /// Integral of 1/r over a rectangle divided by its area, at a surface point (dx, dy) from the centre.
  /// [1/mm] Stable form with asinh: no loss of digits at high aspect ratio.
  double love_potential(const Rectangle &source, double x, double y);

  /// Mean over `target` of love_potential of `source`: symmetric in the two. [1/mm]
  /// Closed form with sixteen corners nearby, Gauss points far away (relative error below 2e-5).
  double mean_love_potential(const Rectangle &source, const Rectangle &target);

  /// Two rectangles of half-lengths a and b, the centre of the second seen from the first's. [mm]
  struct RectanglePair
  {
    double dx, dy, a1, b1, a2, b2;
  };

  /// mean_love_potential() of many pairs at once, written to `mean`, which has as many entries. [1/mm]
  void mean_love_potentials(std::span<const RectanglePair> pairs, std::span<double> mean);

  /// Displacement for unit inward force on the rectangle at the origin, at a point with z >= 0. [mm/N]
  Eigen::Vector3d love_displacement(double a, double b, const Eigen::Vector3d &point, double youngs_modulus,
                                    double poissons_ratio);

  /// Stress tensor for the same (tension positive). [1/mm^2]
  Eigen::Matrix3d love_stress(double a, double b, const Eigen::Vector3d &point, double poissons_ratio);

  /// Displacement [mm/N] and stress [1/mm^2] for a unit inward point force at the origin; point != origin.
  Eigen::Vector3d boussinesq_displacement(const Eigen::Vector3d &point, double youngs_modulus,
                                          double poissons_ratio);
  Eigen::Matrix3d boussinesq_stress(const Eigen::Vector3d &point, double poissons_ratio);
} // namespace flank::half_space
