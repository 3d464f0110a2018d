// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/tip_edge.hpp"

#include <algorithm>

namespace flank
{
  double half_land_angle(const Gear &gear)
  {
    const InvoluteHelicoid flank = gear.flank();
    const double at_tip = flank.half_angle(gear.tip_roll),
                 // As far towards the tooth's middle as up, from where the flank ends.
        at_45_degrees = flank.half_angle(gear.usable_tip_roll) - gear.tip_chamfer / gear.tip_radius;
    return std::clamp(at_45_degrees, at_tip / 3, 0.98 * at_tip);
  }
} // namespace flank
