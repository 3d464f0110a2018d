// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

/// Inside: mm, N, MPa, rad. Every conversion to or from the units users see is here.
namespace flank::units
{
  constexpr double pi = 3.14159265358979323846;

  constexpr double degree = pi / 180.0;         ///< rad per degree
  constexpr double arcsecond = degree / 3600.0; ///< rad per second of arc
  constexpr double micrometre = 1e-3;           ///< mm per um
  constexpr double gigapascal = 1e3;            ///< MPa per GPa
  constexpr double newton_metre = 1e3;          ///< N mm per N m
  constexpr double newton_per_micrometre = 1e3; ///< N/mm per N/um
} // namespace flank::units
