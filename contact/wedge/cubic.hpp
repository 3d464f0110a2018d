// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>

namespace flank::wedge
{
  /// Lagrange's polynomials through the four points -1, 0, 1, 2.
  struct Cubic
  {
    std::array<double, 4> value, derivative;

    explicit Cubic(const double t)
        : value{ -t * (t - 1) * (t - 2) * (1.0 / 6), (t + 1) * (t - 1) * (t - 2) * 0.5,
                 -(t + 1) * t * (t - 2) * 0.5, (t + 1) * t * (t - 1) * (1.0 / 6) }
        , derivative{ -(3 * t * t - 6 * t + 2) / 6, (3 * t * t - 4 * t - 1) / 2, -(3 * t * t - 2 * t - 2) / 2,
                      (3 * t * t - 1) / 6 }
    {
    }
  };
} // namespace flank::wedge
