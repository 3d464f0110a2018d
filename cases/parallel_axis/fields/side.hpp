// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/grid/placement.hpp"

namespace flank
{
  enum class Side
  {
    pinion,
    gear
  };

  inline Placement placement_of(const GearPair &pair, const Side side, const double phase)
  {
    return side == Side::pinion ? pinion_placement(pair, phase) : gear_placement(pair, phase);
  }
} // namespace flank
