// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/tooth_section.hpp"

#include <string>

namespace flank
{
  /// The elastic body behind a flank, clamped at the bore, and how its operator is computed. Bore, model and
  /// support change results; the way of reduction does not.
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
    Kind kind = Kind::ring;
    int segment_teeth = 7;     ///< odd
    bool clamped_cuts = false; ///< of a segment: its two cut faces
    Reduction reduction = Reduction::automatic;
    bool use_mid_plane = true; ///< reduce half of a body whose mid-plane is a plane of symmetry

    /// For reports and the operator's key: model and support, not the way of reduction.
    std::string describe() const;
    std::string describe_reduction() const;
  };

  /// Whether one half of the body stands for both: a spur gear meshed by an even number of layers.
  bool has_mid_plane(const Gear &gear, const SectorResolution &resolution);
} // namespace flank
