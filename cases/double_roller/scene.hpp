// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/scene/scene.hpp"

namespace flank
{
  /// Rollers and sleeves of a cycloid type drive in rolling contact.
  Scene double_roller_scene();
} // namespace flank
