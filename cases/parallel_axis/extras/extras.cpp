// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extras.hpp"

namespace flank
{
  ExtraKind error_estimate(), light_load_pattern(), root_stress(), subsurface_stress(),
      fields(); // a file each

  /// The error estimate first: where it asks for a finer computation the others wait for that.
  const std::vector<ExtraKind> &pair_extras()
  {
    static const std::vector<ExtraKind> all = { error_estimate(), light_load_pattern(), root_stress(),
                                                subsurface_stress(), fields() };
    return all;
  }
} // namespace flank
