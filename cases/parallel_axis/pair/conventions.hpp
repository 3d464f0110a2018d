// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank
{
  /// What stands at the head of every table of a pair of gears.
  inline constexpr const char *conventions =
      "# TE eps = r_b_pinion theta_pinion + r_b_gear theta_gear along the transverse line of action, both "
      "counted in the pinion's sense;\n"
      "# positive when the driven gear lags. te_arcsec: of the driven gear. phase 0: pair 0 at the pitch "
      "point at mid-face; 1: one pitch on.\n"
      "# A_i = 2|c_i|: peak amplitude of mesh harmonic i, eps = mean + sum A_i cos(2 pi i phase + "
      "phase_deg).\n";
} // namespace flank
