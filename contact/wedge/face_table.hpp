// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/shared_memory.hpp"

#include <Eigen/Dense>

#include <array>
#include <map>
#include <mutex>
#include <vector>

namespace flank::wedge
{
  /// How EdgeField is tabulated: steps of the logarithms of radii, and of sinh for places along the edge.
  struct TableAxes
  {
    static constexpr double radius_step = 0.125, along_step = 0.14;
    static constexpr int first_radius = -55, last_radius = 46; ///< 1e-3 to 300 of the load's distance
    static constexpr int n_along = 46;                         ///< 0 to 270 of it
  };

  /// What the free face at a wedge's edge adds to the half-space's displacement on the loaded face: the part
  /// of EdgeField that couples the patches of a flank. Symmetric in place and load.
  class FaceTable
  {
  public:
    /// Columns: radii from the first to two beyond the load's distance; rows: places along the edge.
    static constexpr Eigen::Index rows = TableAxes::n_along, columns = 3 - TableAxes::first_radius;

    FaceTable() = default;

    /// Values times Young's modulus at a load's distance of 1. [1/mm]
    explicit FaceTable(SharedMatrix values);

    /// The displacement into the depth `along` the edge beside a unit force, both at their distance from the
    /// edge, times Young's modulus. [1/mm]
    double at(double along, double place_distance, double distance) const;

    const SharedMatrix &values() const { return values_; }

  private:
    SharedMatrix values_;
  };

  /// Means of a face table over rectangles of the face whose sides lie along the edge and across it. Means
  /// over the distances from the edge are kept, because the slices of a contact repeat. Safe for several
  /// threads.
  class FaceMeans
  {
  public:
    explicit FaceMeans(FaceTable table);

    /// Distances from the edge. [mm]
    struct Strip
    {
      double low, high;
      auto operator<=>(const Strip &) const = default;
    };

    /// Mean over two strips as a function of the place along the edge, interpolated.
    class AlongEdge
    {
    public:
      AlongEdge(const FaceTable &table, const Strip &first, const Strip &second);

      /// Mean over two rectangles of half-lengths a and b, `along` apart. [1/mm]
      double mean(double along, double a, double b) const;

    private:
      double at(double along) const;

      const FaceTable *table_;
      std::array<double, 2> middle_; ///< of the strips [mm]
      double scale_;                 ///< [mm]
      Eigen::MatrixXd value_; ///< coefficients of powers; a column an interval of places along the edge
    };

    /// Mean over two rectangles, of half-lengths a and b along the edge, `along` apart, on two strips: of
    /// strips that are near the edge for their size as between() has it, else from four places of both.
    /// [1/mm]
    double mean(const Strip &first, const Strip &second, double along, double a, double b) const;

    /// Kept as long as the object.
    const AlongEdge &between(const Strip &first, const Strip &second) const;

    const FaceTable &table() const { return table_; }

  private:
    FaceTable table_;
    mutable std::mutex mutex_;
    mutable std::map<std::array<Strip, 2>, AlongEdge> kept_;
  };
} // namespace flank::wedge
