// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/microgeometry.hpp"

#include <Eigen/Dense>

namespace flank
{
  /// A flank given by a table over roll angle and face position: measured, or free. Interpolated by cubic
  /// Hermite polynomials in both directions (once continuously differentiable, slopes from the parabola
  /// through three neighbours, so a table of a quadratic is reproduced); beyond the table its edge values
  /// hold.
  class Topography : public FlankModification
  {
  public:
    /// Ascending roll angles [rad] and face positions [mm] (at least two each); removed: rows by roll angle
    /// [mm]; base radius of the gear [mm]; name: for reports.
    Topography(std::string name, std::vector<double> roll, std::vector<double> z, Eigen::MatrixXd removed,
               double base_radius);
    double removed(double roll, double z) const override;

    /// Of a table: where its curvature over one node or two is more than three times that beside them.
    Turn turn() const override { return turn_; }
    double beyond_start(double, double) const override { return 0; }
    std::string describe(double base_radius) const override;

  private:
    std::string name_;
    std::vector<double> roll_, z_;
    Eigen::MatrixXd removed_;
    Turn turn_;
  };
} // namespace flank
