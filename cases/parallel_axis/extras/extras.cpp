// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extras.hpp"

namespace flank
{
// A function of the extra's file, declared where it is listed: an extra is one line here.
#define FLANK_EXTRA(name)                                                                                    \
  []() -> ExtraKind {                                                                                        \
    extern ExtraKind name();                                                                                 \
    return name();                                                                                           \
  }()

  /// The error estimate first: where it asks for a finer computation the others wait for that.
  const std::vector<ExtraKind> &pair_extras()
  {
    static const std::vector<ExtraKind> all = {
      FLANK_EXTRA(error_estimate), FLANK_EXTRA(light_load_pattern),
      FLANK_EXTRA(root_stress),    FLANK_EXTRA(subsurface_stress),
      FLANK_EXTRA(fields),
    };
    return all;
  }
} // namespace flank
