// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/polygon.hpp"

#include <cmath>

namespace flank
{
  EqualRectangle equal_rectangle(const Polygon &polygon)
  {
    double area = 0;
    Eigen::Vector2d first = Eigen::Vector2d::Zero(), second = first;
    for (std::size_t t = 2; t < polygon.size(); ++t)
      {
        const Eigen::Vector2d &a = polygon[0], &b = polygon[t - 1], &c = polygon[t];
        const double piece = 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
        area += piece;
        first += piece / 3 * (a + b + c);
        second += piece / 12 * (a.cwiseAbs2() + b.cwiseAbs2() + c.cwiseAbs2() + (a + b + c).cwiseAbs2());
      }
    const Eigen::Vector2d centre = first / area;
    Eigen::Vector2d half = (3 * (second / area - centre.cwiseAbs2()).cwiseMax(1e-30)).cwiseSqrt();
    half *= std::sqrt(area / (4 * half.x() * half.y()));
    return { area, centre, half };
  }
} // namespace flank
