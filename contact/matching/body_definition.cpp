// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/body_definition.hpp"

#include <fmt/format.h>

namespace flank
{
  namespace
  {
    std::string in_full(const std::initializer_list<double> values)
    {
      std::string all;
      for (const double value : values)
        all += fmt::format(" {:.17g}", value);
      return all;
    }

    // A field that is added to one of the structures and not here does not compile.

    /// The fields of a gear's data that its compliance depends on. Left out are the name; how thickness and
    /// shift are given, which the geometry has as the half angle at the base; a rounding of the tip, which
    /// the elastic body has not.
    std::string identity_of(const GearData &gear)
    {
      const auto &[name, teeth, face_width, tip_radius, root_radius, tooth_thickness, profile_shift,
                   bore_radius, fillet_radius, youngs_modulus, poissons_ratio, tip_chamfer, tip_rounding] =
          gear;
      return fmt::format("teeth {}", teeth) + in_full({ face_width, tip_radius, root_radius, bore_radius }) +
             in_full({ fillet_radius, tip_chamfer }) + in_full({ youngs_modulus, poissons_ratio });
    }

    /// The fields of a gear's geometry that its compliance depends on. What follows from other fields is left
    /// out.
    std::string identity_of(const GearGeometry &geometry)
    {
      const auto &[reference_radius, base_radius, base_helix_angle, helix_angle, half_angle_at_base, tip_roll,
                   usable_tip_roll, form_radius, form_roll, tip_thickness] = geometry;
      return in_full({ reference_radius, base_radius, base_helix_angle, helix_angle }) +
             in_full({ half_angle_at_base });
    }

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
      const auto &[split, depth, free_ends, points] = near_field;
      return split == Split::projected
                 ? fmt::format("projected split, {} points, free edges {}", points, free_ends)
                 : fmt::format("classical split, depth {}", static_cast<int>(depth));
    }
  } // namespace

  std::string identity(const BodyDefinition &body)
  {
    const auto &[gear, resolution, model, max_offset, near_field] = body;
    return fmt::format("{}\n{}\n{}\nteeth apart {}\n{}",
                       identity_of(static_cast<const GearData &>(gear)) +
                           identity_of(static_cast<const GearGeometry &>(gear)),
                       identity_of(resolution), identity_of(model), max_offset, identity_of(near_field));
  }
} // namespace flank
