// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <boost/math/tools/minima.hpp>

#include <utility>

namespace flank
{
  /// Where a function of one variable is least between `low` and `high`, and its value there: Brent's method
  /// (Boost), the place to 2^-(bits - 1) of the interval. Searched in parts of the interval, because that
  /// method ends at an absolute size of the place too, and a length or torque has none: the same problem in
  /// other units ends at the same place.
  template <class Function>
  std::pair<double, double> least_between(const Function &function, const double low, const double high,
                                          const int bits)
  {
    const auto at = [&](const double part) { return low + (high - low) * part; };
    const auto [part, value] = boost::math::tools::brent_find_minima(
        [&](const double p) { return function(at(p)); }, 0.0, 1.0, bits);
    return { at(part), value };
  }
} // namespace flank
