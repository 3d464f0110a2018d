// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/shared_memory.hpp"
#include "mesh/base/stage_clock.hpp"
#include "solver/elements/body_elements.hpp"
#include "solver/elements/flank_surface.hpp"

#include <string>
#include <vector>

namespace flank
{
  class ParallelSession;

  /// The elastic body behind a flank, clamped at the bore, and how its operator is computed. Bore, model and support change results;
  /// the way of reduction does not.
  struct BodyModel
  {
    enum class Kind
    {
      ring,   ///< the whole gear
      segment ///< some teeth around the loaded one
    };
    enum class Reduction
    {
      automatic,   ///< condensed or distributed, by size
      condensed,   ///< one tooth sector condensed on one process
      distributed, ///< one tooth sector condensed by all ranks together
      direct       ///< all teeth meshed and factored at once, on one process: the check of the others
    };
    Kind      kind          = Kind::ring;
    int       segment_teeth = 7;     ///< odd
    bool      clamped_cuts  = false; ///< of a segment: its two cut faces
    Reduction reduction     = Reduction::automatic;
    bool      use_mid_plane = true; ///< reduce half of a body whose mid-plane is a plane of symmetry

    /// For reports and the operator's key: model and support, not the way of reduction.
    std::string describe() const;
    std::string describe_reduction() const;
  };

  /// Reduced far-field operator of one body in its canonical frame.
  /// matrix[m](i, j): displacement of flank node i of tooth t+m along its inward normal for a unit force on flank node j
  /// of tooth t along that node's inward normal. [mm/N] m = 0 .. max_offset; the other side is the transpose.
  struct FlankCompliance
  {
    FlankSurface              surface;
    std::vector<SharedMatrix> by_tooth_offset;

    /// For the classical split, if asked for: by_depth[d][i, j] is the response at the node below flank node i,
    /// d node planes into the tooth, along i's inward normal, same tooth. Empty otherwise.
    std::vector<SharedMatrix>     by_depth;
    std::vector<Eigen::Matrix3Xd> depth_positions; ///< [mm], of the same nodes
  };

  /// Whether one half of the body stands for both: a spur gear meshed by an even number of layers.
  bool has_mid_plane(const Gear &gear, const SectorResolution &resolution);

  /// An automatic reduction is a condensed one here. depth_planes > 0 asks for the responses below the surface as well (not of a direct
  /// reduction). Distributed: collective over the ranks of `session`; rank 0 receives the operator, the others an empty one. Otherwise
  /// `session` may be null.
  FlankCompliance flank_compliance(const BodyElements &elements, const BodyModel &model, int max_offset, int depth_planes = 0,
                                   const ParallelSession *session = nullptr, StageClock *clock = nullptr);
} // namespace flank
