// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

namespace flank
{
  /// Roll angle where the elastic tooth's flank ends: at its chamfer, else at the tip circle. A rounding's
  /// arc takes less than a tenth of its radius squared off the section, which the body keeps. [rad]
  inline double body_tip_roll(const Gear &gear)
  {
    return gear.tip_chamfer > 0 ? gear.usable_tip_roll : gear.tip_roll;
  }

  /// Angle at the axis of half the tip land that chamfers leave, whose faces lie at 45 degrees. Of a thin tip
  /// a third is left, between steeper ones. [rad]
  double half_land_angle(const Gear &gear);
} // namespace flank
