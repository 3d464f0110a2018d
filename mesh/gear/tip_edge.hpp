// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

namespace flank
{
  /// Whether the elastic tooth has its chamfers. Those of less than a hundredth of its height are left out:
  /// no element is so small. So are roundings, whose arcs take about a tenth of their radius squared off a
  /// corner.
  inline bool has_chamfers(const Gear &gear)
  {
    return gear.tip_chamfer > 0.01 * (gear.tip_radius - gear.root_radius);
  }

  /// Roll angle where the elastic tooth's flank ends: at its chamfer, else at the tip circle. [rad]
  inline double body_tip_roll(const Gear &gear)
  {
    return has_chamfers(gear) ? gear.usable_tip_roll : gear.tip_roll;
  }

  /// Angle at the axis of half the tip land that chamfers leave, whose faces lie at 45 degrees. Of a thin tip
  /// a third is left, between steeper ones. [rad]
  double half_land_angle(const Gear &gear);
} // namespace flank
