// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/iso_6336.hpp"

#include "mesh/base/units.hpp"
#include "mesh/gear/tooth_profile.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  IsoStiffness iso_6336_stiffness(const double z1, const double z2, const double x1, const double x2,
                                  const double helix_angle, const double normal_pressure_angle,
                                  const double dedendum_factor, const double contact_ratio,
                                  const double modulus_ratio)
  {
    // ISO 6336-1:2006, 9.3.1: q' with virtual teeth z/(cos^2(beta_b) cos(beta)), C_M = 0.8, C_R = 1 (solid
    // discs), C_B for the basic rack.
    const double sin_base = std::sin(helix_angle) * std::cos(normal_pressure_angle),
                 virtual_factor = (1 - sin_base * sin_base) * std::cos(helix_angle);
    const double v1 = z1 / virtual_factor, v2 = z2 / virtual_factor;
    const double q = 0.04723 + 0.15551 / v1 + 0.25791 / v2 - 0.00635 * x1 - 0.11654 * x1 / v1 - 0.00193 * x2 -
                     0.24188 * x2 / v2 + 0.00529 * x1 * x1 + 0.00182 * x2 * x2;
    const double rack =
        (1 + 0.5 * (1.2 - dedendum_factor)) * (1 - 0.02 * (20 - normal_pressure_angle / units::degree));
    IsoStiffness result;
    result.theoretical = 1 / q;
    result.single = 0.8 * rack * std::cos(helix_angle) / q * modulus_ratio;
    result.mesh = result.single * (0.75 * contact_ratio + 0.25);
    return result;
  }

  IsoStiffness iso_6336_stiffness(const GearPair &pair)
  {
    const auto dedendum = [&](const Gear &g) {
      return (g.reference_radius - g.root_radius) / pair.normal_module + g.profile_shift;
    };
    const double e1 = pair.pinion.youngs_modulus, e2 = pair.gear.youngs_modulus;
    // Different dedenda: the mean of the two C_B, as the standard says; it is linear in the dedendum.
    return iso_6336_stiffness(pair.pinion.teeth, pair.gear.teeth, pair.pinion.profile_shift,
                              pair.gear.profile_shift, pair.data.helix_angle, pair.normal_pressure_angle,
                              0.5 * (dedendum(pair.pinion) + dedendum(pair.gear)),
                              pair.transverse_contact_ratio, 2 * e1 * e2 / (e1 + e2) / 206e3);
  }

  IsoRootStress iso_6336_root_stress(const GearPair &pair, const Gear &gear)
  {
    const double cos_base = std::cos(pair.base_helix_angle), m = pair.normal_module,
                 alpha = pair.normal_pressure_angle;

    // ISO 6336-3:2006, 6.2.2: the virtual spur gear of the normal section, with the same heights and the
    // normal tooth thickness.
    const double virtual_teeth = gear.teeth / (cos_base * cos_base * std::cos(gear.helix_angle));
    Gear spur = gear;
    spur.teeth = static_cast<int>(std::lround(virtual_teeth)); // only its root land depends on it
    spur.helix_angle = spur.base_helix_angle = 0;
    spur.reference_radius = m * virtual_teeth / 2;
    spur.base_radius = spur.reference_radius * std::cos(alpha);
    spur.tip_radius += spur.reference_radius - gear.reference_radius;
    spur.root_radius += spur.reference_radius - gear.reference_radius;
    const double at_reference = std::acos(gear.base_radius / gear.reference_radius),
                 involute = std::tan(at_reference) - at_reference;
    const double thickness = 2 * gear.reference_radius * (gear.half_angle_at_base - involute) *
                             std::cos(gear.helix_angle); // normal
    spur.half_angle_at_base = thickness / (2 * spur.reference_radius) + std::tan(alpha) - alpha;

    // Load at the outer point of single pair contact; its direction meets the tooth's middle at r_b /
    // cos(alpha_Fen).
    const double ratio = pair.transverse_contact_ratio / (cos_base * cos_base),
                 arc_at_tip =
                     std::sqrt((spur.tip_radius - spur.base_radius) * (spur.tip_radius + spur.base_radius)),
                 load_roll = (arc_at_tip - units::pi * m * std::cos(alpha) * (ratio - 1)) / spur.base_radius;
    const double load_angle = load_roll - spur.half_angle_at_base;

    // Where the tangent to the fillet stands at 30 degrees to the tooth's middle: it turns all the way down.
    const ToothProfile profile(spur);
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i)
      {
        const double at = 0.5 * (low + high);
        const Eigen::Vector2d down = profile.fillet_point(at + 1e-6) - profile.fillet_point(at - 1e-6);
        (std::atan2(down.y(), -down.x()) < 30 * units::degree ? low : high) = at;
      }
    const Eigen::Vector2d critical = profile.fillet_point(0.5 * (low + high));
    IsoRootStress result{};
    result.root_chord = 2 * critical.y();
    result.bending_arm = spur.base_radius / std::cos(load_angle) - critical.x();
    result.form_factor = 6 * result.bending_arm / m * std::cos(load_angle) /
                         (std::pow(result.root_chord / m, 2) * std::cos(alpha));
    const double slender = result.root_chord / result.bending_arm,
                 notch = result.root_chord / (2 * gear.fillet_radius);
    result.stress_correction = (1.2 + 0.13 * slender) * std::pow(notch, 1 / (1.21 + 2.3 / slender));
    result.helix_factor =
        1 - std::min(1.0, pair.overlap_ratio) * std::min(30.0, gear.helix_angle / units::degree) / 120;
    return result;
  }

  std::array<double, 2> iso_6336_nominal_root_stress(const GearPair &pair, const double pinion_torque)
  {
    const double per_width =
        pinion_torque / pair.pinion.reference_radius / (pair.common_face_width * pair.normal_module);
    return { per_width * iso_6336_root_stress(pair, pair.pinion).factor(),
             per_width * iso_6336_root_stress(pair, pair.gear).factor() };
  }
} // namespace flank
