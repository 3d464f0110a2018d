// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/wedge/face_table.hpp"

#include <Eigen/Dense>

namespace flank::wedge
{
  /// What the free face at the edge of an elastic wedge adds to Boussinesq's field of a point load on the
  /// loaded face. A wedge has no length of its own: with the load's distance d from the edge as the unit, the
  /// displacement times E d is a function of the place alone. It is put together from the waves along the
  /// edge (SectionWaves) once, and interpolated.
  ///
  /// Axes of the wedge: x along its edge, s on the loaded face away from the edge, z into the depth. The
  /// load, a unit force along z, stands at (0, d, 0). Together with the half-space's field both faces are
  /// free.
  class EdgeField
  {
  public:
    /// `opening`: angle between both faces, inside the body, from 30 to 180 degrees [rad].
    EdgeField(double opening, double poissons_ratio);

    /// Displacement at a place of the wedge, times Young's modulus. [1/mm]
    Eigen::Vector3d displacement(const Eigen::Vector3d &place, double distance) const;

    /// Its derivatives: a row a component, a column an axis. [1/mm^2]
    Eigen::Matrix3d gradient(const Eigen::Vector3d &place, double distance) const;

    /// The displacement into the depth on the loaded face.
    FaceTable face() const;

    double opening() const { return opening_; }

  private:
    struct Place;
    Place place_of(const Eigen::Vector3d &place, double distance) const;

    struct Cell;
    Cell cell_of(const Place &place) const;

    int elements_across() const { return (n_angles_ - 1) / 3; }

    double opening_;
    int n_angles_;
    Eigen::MatrixXd table_; ///< row 3 angle + component; column (radius, place along the edge)
  };
} // namespace flank::wedge
