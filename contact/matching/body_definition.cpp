// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/body_definition.hpp"

#include <fmt/format.h>

namespace flank
{
  namespace
  {
    std::string identity_of(const Gear &gear)
    {
      const Gear &g = gear;
      std::string all = fmt::format("teeth {}", g.teeth);
      for (const double value : { g.face_width, g.tip_radius, g.root_radius, g.bore_radius, g.fillet_radius,
                                  g.youngs_modulus, g.poissons_ratio, g.reference_radius, g.base_radius,
                                  g.base_helix_angle, g.helix_angle, g.half_angle_at_base })
        all += fmt::format(" {:.17g}", value);
      return all;
    }

    // In the following, a field that is added to a structure and not here does not compile.

    std::string identity_of(const SectorResolution &resolution)
    {
      const auto &[degree, flank_rows, tooth_columns, face_layers, fillet_rows, fillet_columns,
                   root_land_columns, rim_layers] = resolution;
      return fmt::format("degree {} elements {} {} {} {} {} {} {}", degree, flank_rows, tooth_columns,
                         face_layers, fillet_rows, fillet_columns, root_land_columns, rim_layers);
    }

    /// Ways of reduction whose operators are the same bit for bit share a description.
    std::string identity_of(const BodyModel &model)
    {
      const auto &[kind, segment_teeth, clamped_cuts, reduction, use_mid_plane] = model;
      const std::string of_segment =
          kind == BodyModel::Kind::segment ? fmt::format(" {} {}", segment_teeth, clamped_cuts) : "";
      static_cast<void>(reduction);
      return fmt::format("model {}{} mid-plane {}, {}", static_cast<int>(kind), of_segment, use_mid_plane,
                         model.describe_reduction());
    }

    std::string identity_of(const NearField &near_field)
    {
      const auto &[split, depth, points] = near_field;
      return split == Split::projected ? fmt::format("projected split, {} points", points)
                                       : fmt::format("classical split, depth {}", static_cast<int>(depth));
    }
  } // namespace

  std::string identity(const BodyDefinition &body)
  {
    const auto &[gear, resolution, model, max_offset, near_field] = body;
    return fmt::format("{}\n{}\n{}\nteeth apart {}\n{}", identity_of(gear), identity_of(resolution),
                       identity_of(model), max_offset, identity_of(near_field));
  }
} // namespace flank
