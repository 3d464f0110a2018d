// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/between_points.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace flank
{
  namespace
  {
    /// How much of an interval a curve goes on along its line before it jumps (validation/run coverage: 0.63
    /// of it was seen).
    constexpr double before_jump = 0.8;
  } // namespace

  double greatest_between(const PointsOfPeriod &points, const double period, const double sign,
                          const double jump)
  {
    std::vector<std::pair<double, double>> at(points.begin(), points.end());
    for (std::size_t k = 0; k < 3; ++k) // the period closes
      at.emplace_back(at[k].first + period, at[k].second);
    return greatest_between(at, sign, jump);
  }

  double greatest_between(const std::span<const std::pair<double, double>> at, const double sign,
                          const double jump)
  {
    double greatest = -std::numeric_limits<double>::max();
    for (std::size_t k = 0; k + 3 < at.size(); ++k)
      {
        const auto value = [&](const std::size_t i) { return sign * at[k + i].second; };
        const auto apart = [&](const std::size_t i) { return at[k + i + 1].first - at[k + i].first; };
        const double rise = (value(1) - value(0)) / apart(0), fall = (value(3) - value(2)) / apart(2),
                     left = std::min(value(1), value(2) - fall * apart(1)),
                     right = std::min(value(1) + rise * apart(1), value(2)),
                     meet = rise > fall ? (value(2) - fall * apart(1) - value(1)) / (rise - fall) : -1;
        greatest = std::max({ greatest, left, right });
        const double drop = (value(1) - value(2)) / apart(1);
        if (rise > 0 && drop > jump * rise)
          greatest = std::max(greatest, value(1) + before_jump * rise * apart(1));
        if (fall < 0 && drop < jump * fall)
          greatest = std::max(greatest, value(2) - before_jump * fall * apart(1));
        if (meet >= 0 && meet <= apart(1))
          greatest = std::max(greatest, value(1) + rise * meet);
      }
    return greatest;
  }
} // namespace flank
