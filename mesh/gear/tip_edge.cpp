// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/tip_edge.hpp"

#include <algorithm>

namespace flank
{
  double half_land_angle(const Gear &gear)
  {
    const double at_tip = gear.flank().half_angle(gear.tip_roll);
    return std::max(at_tip - gear.tip_chamfer / gear.tip_radius, at_tip / 3);
  }
} // namespace flank
