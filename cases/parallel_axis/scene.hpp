// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/scene/scene.hpp"

namespace flank
{
  /// A spur or helical involute pair.
  Scene parallel_axis_scene();
} // namespace flank
