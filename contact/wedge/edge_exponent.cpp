// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/edge_exponent.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <cmath>

namespace flank::wedge
{
  double pressure_exponent(const EndOfContact &one, const EndOfContact &other)
  {
    // Under the pressure r^(lambda - 1) a wedge's face yields by N / Q over its modulus, times r^lambda.
    const auto n = [](const double lambda, const double angle) {
      return std::sin(2 * lambda * angle) + lambda * std::sin(2 * angle);
    };
    const auto q = [](const double lambda, const double angle) {
      return std::pow(lambda * std::sin(angle), 2) - std::pow(std::sin(lambda * angle), 2);
    };
    const auto yields_together = [&](const double lambda) {
      return n(lambda, one.opening) * q(lambda, other.opening) / one.modulus +
             n(lambda, other.opening) * q(lambda, one.opening) / other.modulus;
    };
    constexpr double least = 0.05, greatest = 0.995; // 0 and 1 are roots that mean nothing
    constexpr int steps = 200;
    for (int k = 0; k < steps; ++k)
      {
        const double low = least + (greatest - least) * k / steps,
                     high = least + (greatest - least) * (k + 1) / steps, at_low = yields_together(low),
                     at_high = yields_together(high);
        if (at_low * at_high > 0)
          continue;
        boost::uintmax_t iterations = 60;
        const auto root =
            boost::math::tools::toms748_solve(yields_together, low, high, at_low, at_high,
                                              boost::math::tools::eps_tolerance<double>(40), iterations);
        return 0.5 * (root.first + root.second) - 1;
      }
    return 0;
  }
} // namespace flank::wedge
