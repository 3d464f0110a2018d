// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/face_ends.hpp"

namespace flank
{
  /// Angle between a flank and what follows at its tip, inside the tooth: the tip land, or a chamfer at 45
  /// degrees; in the plane at right angles to the edge. [rad]
  double opening_at_tip(const Gear &gear);

  /// Powers of the distance with which the pressure goes at the sharp tip edges of both gears, pressed into
  /// the other's flank, as wedge::pressure_exponent() tells; the pinion's first; 0: the tip is rounded.
  /// Between half-spaces a contact that is cut off is singular with the power -1/2.
  std::array<double, 2> tip_powers(const GearPair &pair, EndsOfFlanks ends = EndsOfFlanks::free);
} // namespace flank
