// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/report/iso_6336.hpp"

#include "mesh/base/units.hpp"

#include <cmath>

namespace flank
{
  IsoStiffness iso_6336_stiffness(const double z1, const double z2, const double x1, const double x2, const double helix_angle,
                                  const double normal_pressure_angle, const double dedendum_factor, const double contact_ratio,
                                  const double modulus_ratio)
  {
    // ISO 6336-1:2006, 9.3.1: q' with virtual teeth z/(cos^2(beta_b) cos(beta)), C_M = 0.8, C_R = 1 (solid discs), C_B for the basic rack.
    const double sin_base       = std::sin(helix_angle) * std::cos(normal_pressure_angle),
                 virtual_factor = (1 - sin_base * sin_base) * std::cos(helix_angle);
    const double v1 = z1 / virtual_factor, v2 = z2 / virtual_factor;
    const double q = 0.04723 + 0.15551 / v1 + 0.25791 / v2 - 0.00635 * x1 - 0.11654 * x1 / v1 - 0.00193 * x2 - 0.24188 * x2 / v2 +
                     0.00529 * x1 * x1 + 0.00182 * x2 * x2;
    const double rack = (1 + 0.5 * (1.2 - dedendum_factor)) * (1 - 0.02 * (20 - normal_pressure_angle / units::degree));
    IsoStiffness result;
    result.theoretical = 1 / q;
    result.single      = 0.8 * rack * std::cos(helix_angle) / q * modulus_ratio;
    result.mesh        = result.single * (0.75 * contact_ratio + 0.25);
    return result;
  }

  IsoStiffness iso_6336_stiffness(const GearPair &pair)
  {
    const auto   dedendum = [&](const Gear &g) { return (g.reference_radius - g.root_radius) / pair.normal_module + g.profile_shift; };
    const double e1 = pair.pinion.youngs_modulus, e2 = pair.gear.youngs_modulus;
    // Different dedenda: the mean of the two C_B, as the standard says; it is linear in the dedendum.
    return iso_6336_stiffness(pair.pinion.teeth, pair.gear.teeth, pair.pinion.profile_shift, pair.gear.profile_shift, pair.data.helix_angle,
                              pair.normal_pressure_angle, 0.5 * (dedendum(pair.pinion) + dedendum(pair.gear)),
                              pair.transverse_contact_ratio, 2 * e1 * e2 / (e1 + e2) / 206e3);
  }
} // namespace flank
