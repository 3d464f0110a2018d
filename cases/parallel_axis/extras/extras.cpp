// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extras.hpp"

#include "cases/scene/listed.hpp"

namespace flank
{
  /// The error estimate first: where it asks for a finer computation the others wait for that.
  const std::vector<ExtraKind> &pair_extras()
  {
    static const std::vector<ExtraKind> all = {
      FLANK_LISTED(ExtraKind, error_estimate), FLANK_LISTED(ExtraKind, light_load_pattern),
      FLANK_LISTED(ExtraKind, root_stress),    FLANK_LISTED(ExtraKind, subsurface_stress),
      FLANK_LISTED(ExtraKind, fields),
    };
    return all;
  }
} // namespace flank
