// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/face_ends.hpp"

#include "contact/flanks/mesh_position.hpp"
#include "contact/wedge/edge_exponent.hpp"
#include "mesh/base/units.hpp"

#include <cmath>

namespace flank
{
  /// The inward normal leans towards +z or -z by the base helix angle.
  double opening_at(const Gear &gear, const FlankEnd end)
  {
    return units::pi / 2 - sign_of(end) * gear.base_helix_angle;
  }

  std::array<double, 2> end_powers(const GearPair &pair, const EndsOfFlanks ends)
  {
    if (ends == EndsOfFlanks::half_space)
      return { -0.5, -0.5 };
    const double z_sign = canonical_z_sign(pair.data), gear_z = z_sign * pair.data.axial_offset,
                 near = 1e-6 * pair.common_face_width;
    const auto body = [](const Gear &gear, const FlankEnd end, const bool ends_there) {
      return wedge::EndOfContact{ ends_there ? opening_at(gear, end) : units::pi,
                                  gear.youngs_modulus / (1 - std::pow(gear.poissons_ratio, 2)) };
    };
    const auto power = [&](const FlankEnd end) {
      const double sign = sign_of(end),
                   common = sign * z_sign * (sign * z_sign > 0 ? pair.face_high : pair.face_low);
      const auto stops = [&](const Gear &gear, const double middle) {
        return sign * middle + gear.face_width / 2 < common + near;
      };
      // The gear's own z runs the other way.
      const FlankEnd of_gear = end == FlankEnd::low ? FlankEnd::high : FlankEnd::low;
      constexpr double nearly_none = 0.02;
      const double exponent = wedge::pressure_exponent(body(pair.pinion, end, stops(pair.pinion, 0)),
                                                       body(pair.gear, of_gear, stops(pair.gear, gear_z)));
      return exponent < -nearly_none ? exponent : 0.0;
    };
    return { power(FlankEnd::low), power(FlankEnd::high) };
  }
} // namespace flank
