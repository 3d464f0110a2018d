// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extras.hpp"

namespace flank
{
  ExtraKind light_load_pattern(), root_stress(), subsurface_stress(), fields(),
      error_estimate(); // a file each

  const std::vector<ExtraKind> &pair_extras()
  {
    static const std::vector<ExtraKind> all = { light_load_pattern(), root_stress(), subsurface_stress(),
                                                fields(), error_estimate() };
    return all;
  }
} // namespace flank
