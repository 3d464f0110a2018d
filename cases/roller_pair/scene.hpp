// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/scene/scene.hpp"

namespace flank
{
  /// Two crowned cylinders pressed together, Hertz's formulas beside them. The smallest scene: the one to
  /// copy for a new kind of drive.
  Scene roller_pair_scene();
} // namespace flank
