// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <cstdint>
#include <utility>

namespace flank
{
  /// Where a function of one variable is least between `low` and `high`, and its value there: Brent's method
  /// (1973; Boost), the place to 2^-(bits - 1) of the interval. Searched in parts of the interval, because
  /// that method ends at an absolute size of the place too, and a length or torque has none: the same problem
  /// in other units ends at the same place.
  template <class Function>
  std::pair<double, double> least_between(const Function &function, const double low, const double high,
                                          const int bits)
  {
    const auto at = [&](const double part) { return low + (high - low) * part; };
    const auto [part, value] = boost::math::tools::brent_find_minima(
        [&](const double p) { return function(at(p)); }, 0.0, 1.0, bits);
    return { at(part), value };
  }

  /// The same of a function whose slope is known and may jump: where the slope changes its sign, to rounding,
  /// which the function's values alone give to its root. Without a change of sign as above.
  template <class Function, class Slope>
  std::pair<double, double> least_where_flat(const Function &function, const Slope &slope, const double low,
                                             const double high, const int bits)
  {
    const double at_low = slope(low), at_high = slope(high);
    if (!(at_low < 0 && at_high > 0))
      return least_between(function, low, high, bits);
    const auto at = [&](const double part) { return low + (high - low) * part; };
    std::uintmax_t iterations = 200;
    const auto [before, after] = boost::math::tools::toms748_solve(
        [&](const double part) { return slope(at(part)); }, 0.0, 1.0, at_low, at_high,
        boost::math::tools::eps_tolerance<double>(50), iterations);
    const double place = at((before + after) / 2);
    return { place, function(place) };
  }
} // namespace flank
