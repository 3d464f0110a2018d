// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/tip_edges.hpp"

#include "contact/wedge/edge_exponent.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/tip_edge.hpp"

#include <cmath>

namespace flank
{
  double opening_at_tip(const Gear &gear)
  {
    // Directions from the edge, counted from the radius towards the tooth's middle; in the transverse plane,
    // then in the one at right angles to the edge, which lies at the helix angle there.
    const double across = 1 / std::hypot(1, gear.flank().twist() * gear.usable_tip_radius()),
                 flank = std::atan(across * gear.usable_tip_roll),
                 next = has_chamfers(gear) ? std::atan(across) : units::pi / 2;
    return units::pi - (next - flank);
  }

  std::array<double, 2> tip_powers(const GearPair &pair, const EndsOfFlanks ends)
  {
    const auto power = [&](const Gear &gear, const Gear &other) {
      if (gear.tip_rounding > 0)
        return 0.0;
      if (ends == EndsOfFlanks::half_space)
        return -0.5;
      const auto modulus = [](const Gear &of) {
        return of.youngs_modulus / (1 - of.poissons_ratio * of.poissons_ratio);
      };
      return wedge::pressure_exponent({ opening_at_tip(gear), modulus(gear) }, { units::pi, modulus(other) });
    };
    return { power(pair.pinion, pair.gear), power(pair.gear, pair.pinion) };
  }
} // namespace flank
