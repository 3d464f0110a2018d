// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <map>
#include <span>
#include <utility>

namespace flank
{
  /// Points of a curve over its period: values by place, three at least.
  using PointsOfPeriod = std::map<double, double>;

  /// The greatest value of any curve through the points that bends one way, downwards, between two
  /// neighbours: it stays below the lines through the next points on either side. Where it jumps, as that of
  /// a spur pair does where a tooth pair begins to carry, it may have gone on along its line. `sign` -1: of
  /// the curve turned over. `jump`: a curve that turns may jump where it is more than so many times as steep
  /// as before.
  double greatest_between(const PointsOfPeriod &points, double period, double sign, double jump = 2);

  /// The same of points, by ascending place, that are no period: from the second to the last but one.
  double greatest_between(std::span<const std::pair<double, double>> points, double sign, double jump = 2);
} // namespace flank
