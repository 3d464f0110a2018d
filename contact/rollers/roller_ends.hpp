// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/roller_pair.hpp"

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace flank
{
  namespace wedge
  {
    class FaceTable;
  }

  /// The free ends of two rollers with parallel axes. An end face is at right angles to the surface, so that
  /// near it a roller is an elastic quarter-space; what its free face adds to the half-space counts for every
  /// cell of the contact, of both ends and both rollers, each end as if it were alone.
  class RollerEnds
  {
  public:
    RollerEnds(const CrownedRoller &first, const CrownedRoller &second);

    /// A grid over the contact: equal columns across it; rows from mid-length to an end. [mm]
    struct Cells
    {
      int columns;
      double half_across;
      std::vector<double> borders; ///< of the rows, from 0 on, ascending

      int rows() const { return static_cast<int>(borders.size()) - 1; }
    };

    /// What the ends add to the mean displacement of a cell under a unit force on another: an entry a row of
    /// the first; rows of it: columns between both, columns of it: row of the second, counted from the last
    /// one of the other half, -rows, on. Symmetric in both. [mm/N]
    std::vector<Eigen::MatrixXd> between(const Cells &cells) const;

    /// The power of the distance with which the pressure goes at the ends of the contact: 0 where it is
    /// finite, as at ends that both rollers have there; negative where the longer roller goes on.
    double pressure_exponent() const { return exponent_; }

  private:
    using Faces = std::array<const wedge::FaceTable *, 2>; ///< of the rollers' ends

    /// By how many columns lie between, of two rows. [mm/N]
    Eigen::VectorXd between(const Faces &faces, const Cells &cells, int row, int other) const;

    std::array<double, 2> half_length_, compliance_; ///< [mm], 1/E [mm^2/N]
    std::array<double, 2> poissons_ratio_;
    double exponent_;
  };
} // namespace flank
