// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

#include <array>

namespace flank
{
  /// One of both ends of a flank, or none.
  enum class FlankEnd
  {
    low,  ///< z = -b/2
    high, ///< z = b/2
    none
  };

  /// The sign of an end's z; 0: of none.
  constexpr int sign_of(const FlankEnd end)
  {
    return end == FlankEnd::low ? -1 : end == FlankEnd::high ? 1 : 0;
  }

  /// Angle between a flank and its face end, inside the body: the flank is ruled and the end a plane, so it
  /// is the same all along the end's profile, 90 degrees less or more the base helix angle. [rad]
  double opening_at(const Gear &gear, FlankEnd end);

  /// How the ends of flanks count near the contact.
  enum class EndsOfFlanks
  {
    free,      ///< as edges of elastic wedges
    half_space ///< as if the half-space went on
  };

  /// Powers of the distance with which the pressure goes at both ends of the common face, low and high in the
  /// canonical frame (canonical_z_sign()), as wedge::pressure_exponent() tells of the bodies there: one whose
  /// face ends within a millionth of the common face width is a wedge, the other goes on. Negative: pressure
  /// is singular there, as at the end of one gear on a longer one; 0: it has a limit, as at ends that both
  /// gears of one material have in common. Powers closer to 0 than 1/50 count as 0: pressure grows by 5 %
  /// over a tenth of the distance. Between half-spaces a contact that is cut off is singular with the power
  /// -1/2.
  std::array<double, 2> end_powers(const GearPair &pair, EndsOfFlanks ends = EndsOfFlanks::free);
} // namespace flank
