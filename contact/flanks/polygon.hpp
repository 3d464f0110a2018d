// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <boost/container/small_vector.hpp>

namespace flank
{
  /// Convex polygon, corners in order; a clipped rectangle needs no memory of its own.
  using Polygon = boost::container::small_vector<Eigen::Vector2d, 8>;

  /// The part of a polygon where `inside` >= 0, a function of a point that is taken as linear along the
  /// sides.
  template <class Inside>
  Polygon clip(const Polygon &polygon, const Inside &inside)
  {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      {
        const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double ia = inside(a), ib = inside(b);
        if (ia >= 0)
          kept.push_back(a);
        if ((ia > 0 && ib < 0) || (ia < 0 && ib > 0))
          kept.push_back(a + ia / (ia - ib) * (b - a));
      }
    return kept;
  }

  /// Area, centroid and the half-sides of the axis-parallel rectangle of equal area and equal ratio of second
  /// moments.
  struct EqualRectangle
  {
    double area;
    Eigen::Vector2d centre, half;
  };
  EqualRectangle equal_rectangle(const Polygon &polygon);
} // namespace flank
