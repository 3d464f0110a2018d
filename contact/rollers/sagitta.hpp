// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

namespace flank
{
  /// Distance of a circle from its tangent at x from where they touch, without cancellation; of a hollow one
  /// (radius < 0) negative. [mm]
  inline double sagitta(const double radius, const double x)
  {
    return std::copysign(x * x / (std::abs(radius) + std::sqrt(std::max(0.0, radius * radius - x * x))),
                         radius);
  }
} // namespace flank
