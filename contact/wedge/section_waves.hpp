// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

namespace flank::wedge
{
  /// Waves along the edge of an elastic wedge, by finite elements over its section: cubic ones in the
  /// logarithm of the distance r from the edge and in the angle theta from the loaded face. What they correct
  /// is the half-space under a wave of line load on that face: on the wedge's other face they take its
  /// tractions off. One wave number serves all, because a wedge has no length of its own: lengths are counted
  /// in its inverse.
  class SectionWaves
  {
  public:
    /// `opening`: angle between both faces, inside the body [rad].
    SectionWaves(double opening, double poissons_ratio);

    int angles() const { return n_angles_; } ///< of nodes, from the loaded face (0) to the other one
    double angle(int i) const;               ///< [rad]

    /// The correction under unit line loads cos(x) at distances exp(log_distance[j]) from the edge, at radii
    /// exp(log_radius[i]) and the angles of the nodes: displacement times Young's modulus, dimensionless.
    /// Row 3 (i angles() + angle) + component: of sin(x) along the edge, of cos(x) along the loaded face away
    /// from the edge and into its depth; a column a load. Within the least radius of the elements it is what
    /// it is there, beyond the greatest it is 0.
    Eigen::MatrixXd response(const Eigen::VectorXd &log_distance, const Eigen::VectorXd &log_radius) const;

  private:
    double opening_, poissons_ratio_;
    int n_angles_;
  };
} // namespace flank::wedge
