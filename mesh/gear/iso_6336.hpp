// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

#include <array>

namespace flank
{
  /// Tooth stiffness by ISO 6336-1:2006, method B, of a pair of solid discs. [N/(mm um)]
  struct IsoStiffness
  {
    double theoretical; ///< c'_th
    double single;      ///< c'
    double mesh;        ///< c_gamma_alpha

    /// c_gamma_beta, for the load along the face: 0.85 c_gamma_alpha (ISO 6336-1, 9.3.2).
    double mesh_beta() const { return 0.85 * mesh; }
  };
  IsoStiffness iso_6336_stiffness(const GearPair &pair);

  /// The same from the standard's own quantities. Angles [rad]; dedendum_factor: h_fP/m_n of the basic rack;
  /// modulus_ratio: E/206 GPa.
  IsoStiffness iso_6336_stiffness(double z1, double z2, double x1, double x2, double helix_angle,
                                  double normal_pressure_angle, double dedendum_factor, double contact_ratio,
                                  double modulus_ratio);

  /// Tooth root stress by ISO 6336-3:2006, method B, of one gear of a pair: nominal, all load factors 1. The
  /// form factor is taken of the tooth as it is drawn (30 degree tangent to the circular fillet), for a
  /// helical gear of the virtual spur gear with the same fillet radius.
  struct IsoRootStress
  {
    double form_factor, stress_correction, helix_factor; ///< Y_F, Y_S, Y_beta
    double root_chord, bending_arm;                      ///< s_Fn, h_Fe [mm]

    /// sigma_F0 [MPa] per tangential force over face width and normal module [MPa].
    double factor() const { return form_factor * stress_correction * helix_factor; }
  };
  IsoRootStress iso_6336_root_stress(const GearPair &pair, const Gear &gear);

  /// sigma_F0 of both gears (pinion, gear) at a torque of the pinion [N mm]. [MPa]
  std::array<double, 2> iso_6336_nominal_root_stress(const GearPair &pair, double pinion_torque);
} // namespace flank
