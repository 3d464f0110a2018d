// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank::wedge
{
  /// A body at the end of a contact: the angle inside it between the contact and its free face [rad] (pi: it
  /// goes on), its plane-strain modulus E / (1 - nu^2).
  struct EndOfContact
  {
    double opening, modulus;
  };

  /// How the pressure of two bodies pressed together without friction goes at the end that they have in
  /// common: as the distance to this power. Negative: it is singular, and mean pressures of cells grow as
  /// cells shrink; 0: it is finite. From the equation of Dundurs and Lee (1972), of Airy's functions
  /// r^(lambda + 1) on both wedges, whose exponents lambda below 1 are looked for; powers closer to 0 than
  /// 1/200 count as 0.
  double pressure_exponent(const EndOfContact &one, const EndOfContact &other);
} // namespace flank::wedge
