// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/pair_case.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Teeth of a gear between tooth pairs in reach of each other: one more than the contact ratio on either
    /// side.
    int teeth_apart(const GearPair &pair, const Gear &gear)
    {
      return std::min(static_cast<int>(std::ceil(pair.total_contact_ratio())) + 2, gear.teeth / 2);
    }
  } // namespace

  std::vector<BodyDefinition> ParallelAxisCase::bodies() const
  {
    const auto definition = [&](const Gear &own, const SectorResolution &mesh) {
      return BodyDefinition{ .gear = own,
                             .resolution = mesh,
                             .model = body,
                             .max_offset = teeth_apart(pair, own),
                             .near_field = near_field };
    };
    const BodyDefinition pinion = definition(pair.pinion, pinion_mesh),
                         gear = definition(pair.gear, gear_mesh);
    return identity(pinion) == identity(gear) ? std::vector{ pinion } : std::vector{ pinion, gear };
  }

  bool ParallelAxisCase::has_tilt_springs() const
  {
    for (const Mounting &mounting : { pinion_mounting, gear_mounting })
      if (mounting.tilt_in_plane < Mounting::rigid || mounting.tilt_across < Mounting::rigid)
        return true;
    return false;
  }
} // namespace flank
