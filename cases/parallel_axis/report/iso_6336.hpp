// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

namespace flank
{
  /// Tooth stiffness by ISO 6336-1:2006, method B, of a pair of solid discs. [N/(mm um)]
  struct IsoStiffness
  {
    double theoretical; ///< c'_th
    double single;      ///< c'
    double mesh;        ///< c_gamma_alpha
  };
  IsoStiffness iso_6336_stiffness(const GearPair &pair);

  /// From the standard's own quantities. Angles [rad]; dedendum_factor: h_fP/m_n of the basic rack; modulus_ratio: E/206 GPa.
  IsoStiffness iso_6336_stiffness(double z1, double z2, double x1, double x2, double helix_angle, double normal_pressure_angle,
                                  double dedendum_factor, double contact_ratio, double modulus_ratio);
} // namespace flank
