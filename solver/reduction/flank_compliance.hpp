// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/shared_memory.hpp"
#include "mesh/base/stage_clock.hpp"
#include "solver/elements/body_elements.hpp"
#include "solver/reduction/body_model.hpp"

#include <vector>

namespace flank
{
  class ParallelSession;

  /// Reduced far-field operator of one body in its canonical frame.
  /// by_tooth_offset[m](i, j): displacement of flank node i of tooth t+m along its inward normal for a unit
  /// force on flank node j of tooth t along that node's inward normal. [mm/N] m = 0 .. max_offset; the other
  /// side is the transpose.
  struct FlankCompliance
  {
    FlankSurface surface;
    std::vector<SharedMatrix> by_tooth_offset;

    /// For the classical split, if asked for: by_depth[d][i, j] is the response at the node below flank node
    /// i, d node planes into the tooth, along i's inward normal, same tooth. Empty otherwise.
    std::vector<SharedMatrix> by_depth;
    std::vector<Eigen::Matrix3Xd> depth_positions; ///< of the nodes below the flank [mm]
  };

  /// Reduces a body. BodyModel::Reduction::automatic means condensed here. depth_planes > 0 asks for the
  /// responses below the surface as well (not of a direct reduction). Distributed: collective over the ranks
  /// of `session`; rank 0 receives the operator, the others an empty one. Otherwise `session` may be null.
  FlankCompliance flank_compliance(const BodyElements &elements, const BodyModel &model, int max_offset,
                                   int depth_planes = 0, const ParallelSession *session = nullptr,
                                   StageClock *clock = nullptr);
} // namespace flank
