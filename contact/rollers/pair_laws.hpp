// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/roller_contact.hpp"

#include <map>
#include <memory>
#include <mutex>

namespace flank
{
  /// Load-approach laws of all pairs, by the sleeve's radius of curvature. Circular sleeves share one law.
  /// The conjugate profile has laws at a ladder of relative radii, each made when it is first asked for;
  /// between two of them, at equal approach, ln(force) is linear in ln(radius).
  class PairLaws
  {
  public:
    PairLaws(const RollerContactData &contact, const RollerGridSize &grid);
    PairState at_approach(double sleeve_radius, double approach) const;
    PairState load_at(double sleeve_radius, double approach) const; ///< without pressures
    PressureMap map(double sleeve_radius, double force) const;

  private:
    const PairLaw &rung(int index) const;

    RollerContactData contact_;
    RollerGridSize grid_;
    std::unique_ptr<PairLaw> circle_;
    mutable std::mutex mutex_;
    mutable std::map<int, std::unique_ptr<PairLaw>> ladder_;
  };
} // namespace flank
