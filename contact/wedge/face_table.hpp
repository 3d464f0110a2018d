// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/shared_memory.hpp"

#include <Eigen/Dense>

#include <array>

namespace flank::wedge
{
  /// How EdgeField is tabulated: steps of the logarithms of radii, and of asinh of places along the edge.
  struct TableAxes
  {
    static constexpr double radius_step = 0.125, along_step = 0.14;
    static constexpr int first_radius = -55, last_radius = 46; ///< 1e-3 to 300 of the load's distance
    static constexpr int n_along = 46;                         ///< 0 to 270 of it
  };

  /// Distances from the edge between which a patch lies. [mm]
  struct Strip
  {
    double low, high;
    double length() const { return high - low; }
    double middle() const { return 0.5 * (low + high); }
    bool operator==(const Strip &) const = default;
  };

  /// What the free face at a wedge's edge adds to the half-space's displacement on the loaded face: the part
  /// of EdgeField that couples the patches of a flank. Symmetric in place and load.
  class FaceTable
  {
  public:
    /// Columns: radii from the first to two beyond the load's distance. Rows: places along the edge, as
    /// TableAxes has them; of the integrals from 1e-3 to 5 of the distance, in steps of the logarithm.
    static constexpr Eigen::Index rows = TableAxes::n_along, columns = 3 - TableAxes::first_radius,
                                  rows_of_integrals = 14 - TableAxes::first_radius;

    FaceTable() = default;

    /// What displacements() and integrals() were.
    FaceTable(SharedMatrix displacements, SharedMatrix integrals);

    /// Displacements at a load's distance of 1, times Young's modulus [1/mm]; integrates them.
    explicit FaceTable(const Eigen::MatrixXd &displacements);

    /// Some numbers side by side, as a processor's vectors take them.
    using Pack = Eigen::Array<double, 4, 1>;

    /// The displacement into the depth `along` the edge beside a unit force, both at their distance from the
    /// edge, times Young's modulus. [1/mm]
    Pack at(const Pack &along, const Pack &place_distance, const Pack &distance) const;
    double at(double along, double place_distance, double distance) const;

    /// Its mean over two strips. [1/mm]
    double mean(double along, const Strip &first, const Strip &second) const;

    const SharedMatrix &displacements() const { return displacements_; }
    const SharedMatrix &integrals() const { return integrals_; }

  private:
    /// As mean(), from some of Gauss's places of both strips. [1/mm]
    double by_places(int points, double along, const Strip &first, const Strip &second) const;

    void mirror();
    double between(int column, const std::array<double, 4> &by_radius, int row,
                   const std::array<double, 4> &by_along) const;

    /// Integral over distances from 0 on, both up to these. [mm]
    double integral(double along, double one, double other) const;

    SharedMatrix displacements_, integrals_;
    SharedMatrix
        mirrored_; ///< displacements, with the row before the first one: they are even along the edge
  };
} // namespace flank::wedge
