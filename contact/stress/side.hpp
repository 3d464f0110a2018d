// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/placement.hpp"
#include "contact/loaded/position_result.hpp"

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

  /// Calls use(patch, normal force [N]) for every loaded cell of a contact as one of the bodies sees it.
  template <class Use>
  void each_loaded_patch(const PositionResult &result, const Side side, const Use &use)
  {
    for (std::size_t i = 0; i < result.contact_cells->size(); ++i)
      if (const double force = result.contact_force[static_cast<Eigen::Index>(i)]; force > 0)
        use(side == Side::pinion ? (*result.contact_cells)[i].pinion : (*result.contact_cells)[i].gear,
            force);
  }
} // namespace flank
