// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/extras/extra_kind.hpp"

namespace flank
{
  /// All optional outputs of a pair of gears, in the order in which they are computed and told.
  const std::vector<ExtraKind> &pair_extras();
} // namespace flank
