// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/mesh_position.hpp"
#include "contact/half_space/subsurface.hpp"
#include "contact/matching/flank_edges.hpp"

#include <vector>

namespace flank
{
  /// The free ends and sharp tips of the flanks of both gears.
  struct EdgesOfPair
  {
    FlankEdges pinion, gear;

    explicit EdgesOfPair(const GearPair &pair)
        : pinion(pair.pinion)
        , gear(pair.gear)
    {
    }
  };

  /// Greatest stresses below the slice of the greatest pressure that has a limit [MPa], under the forces [N]
  /// on all cells of its tooth pair, in the body where they are greater. Each body counts as a half-space of
  /// its material; within three widths of the contact from a free end or a sharp tip, as the elastic wedge
  /// that it is there. `edges`: null: the half-space goes on there.
  half_space::SubsurfaceStress below_greatest_pressure(const GearPair &pair, const EdgesOfPair *edges,
                                                       const std::vector<ContactCell> &cells,
                                                       const Eigen::VectorXd &force,
                                                       const Eigen::VectorXd &pressure);
} // namespace flank
