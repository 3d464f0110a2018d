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

  /// How far a roller's surface stands back at `along` from its middle: straight over straight_length, then a
  /// crown of this radius; radius 0: straight all over. [mm]
  inline double crown_drop(const double crown_radius, const double straight_length, const double along)
  {
    const double beyond = std::abs(along) - straight_length / 2;
    return crown_radius > 0 && beyond > 0 ? sagitta(crown_radius, beyond) : 0;
  }
} // namespace flank
