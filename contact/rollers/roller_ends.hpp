// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/roller_pair.hpp"
#include "contact/wedge/face_table.hpp"

#include <array>
#include <memory>
#include <mutex>

namespace flank
{
  /// The free ends of two rollers with parallel axes. An end face is at right angles to the surface, so that
  /// near it a roller is an elastic quarter-space; what its free face adds to the half-space counts for every
  /// cell of the contact, of both ends and both rollers, each end as if it were alone.
  class RollerEnds
  {
  public:
    RollerEnds(const CrownedRoller &first, const CrownedRoller &second);

    /// What the ends add to the mean displacement of one cell under a unit force on another, both of these
    /// half-lengths, at their places along the axes from mid-length. [mm/N]
    class Rows
    {
    public:
      Rows(const RollerEnds &ends, double place, double other, double half_along);

      /// `across`: between the middles of the cells; `half_across`: of both.
      double between(double across, double half_across) const;

    private:
      std::array<const wedge::FaceMeans::AlongEdge *, 4> means_; ///< two ends of two rollers
      std::array<double, 2> compliance_;                         ///< of the rollers [mm^2/N]
    };

    /// The power of the distance with which the pressure goes at the ends of the contact: 0 where it is
    /// finite, as at ends that both rollers have there; negative where the longer roller goes on.
    double pressure_exponent() const { return exponent_; }

  private:
    const std::array<std::shared_ptr<const wedge::FaceMeans>, 2> &means() const;

    std::array<double, 2> half_length_, compliance_; ///< [mm], [mm^2/N]
    std::array<double, 2> poissons_ratio_;
    double exponent_;
    mutable std::once_flag once_; ///< the means are made when they are first asked for
    mutable std::array<std::shared_ptr<const wedge::FaceMeans>, 2> means_;
  };
} // namespace flank
