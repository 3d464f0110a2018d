// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank::wedge
{
  /// Stresses (tension positive) of a half-space z >= 0 under a line load cos(x) on its surface at s = 0, of
  /// unit amplitude and pointing inward: amplitudes at a place (s, z), of cos(x) but for xs and xz, which are
  /// those of sin(x). x runs along the line, s across it. Lengths are counted in the inverse wave number.
  struct WaveStress
  {
    double xx, ss, zz, sz, xs, xz;
  };

  /// The stresses at (s, z) != (0, 0), z >= 0. They are the Fourier transform along x of Boussinesq's
  /// stresses below a point load, in Love's potentials (1929): V = 1/rho becomes 2 K_0(R), and what comes
  /// from log(z + rho) is integrated over the depth.
  WaveStress wave_load_stress(double s, double z, double poissons_ratio);
} // namespace flank::wedge
