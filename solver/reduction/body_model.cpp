// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/body_model.hpp"

#include <fmt/format.h>

namespace flank
{
  std::string BodyModel::describe() const
  {
    return kind == Kind::ring
               ? "ring: the whole gear, clamped at the bore"
               : fmt::format("segment: {} teeth around the loaded one, clamped at the bore, cut faces {}",
                             segment_teeth, clamped_cuts ? "clamped" : "free");
  }

  std::string BodyModel::describe_reduction() const
  {
    switch (reduction)
      {
      case Reduction::direct:
        return "all teeth meshed and factored at once";
      case Reduction::distributed:
        return "one tooth sector, shared out over the ranks";
      default:
        return "one tooth sector";
      }
  }

  bool has_mid_plane(const Gear &gear, const SectorResolution &resolution)
  {
    return gear.base_helix_angle == 0 && resolution.face_layers % 2 == 0;
  }
} // namespace flank
