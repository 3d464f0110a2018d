// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/hertz.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <cmath>

namespace flank::half_space
{
  namespace
  {
    using boost::math::ellint_rd, boost::math::ellint_rf, units::pi;

    /// Short over long half-axis, from B/A = R_D(0, 1, k^2) / R_D(0, k^2, 1), which falls as k grows to 1.
    double axis_ratio(const double curvature_ratio)
    {
      if (curvature_ratio == 1)
        return 1;
      const auto excess = [&](const double log_k) {
        const double k2 = std::exp(2 * log_k);
        return std::log(ellint_rd(0.0, 1.0, k2) / ellint_rd(0.0, k2, 1.0) / curvature_ratio);
      };
      // B/A lies between 1/k and 1/k^2.
      const double low = -std::log(curvature_ratio) - 1e-9, high = 1e-9;
      std::uintmax_t iterations = 200;
      const auto [a, b] = boost::math::tools::toms748_solve(
          excess, low, high, boost::math::tools::eps_tolerance<double>(52), iterations);
      return std::exp(0.5 * (a + b));
    }
  } // namespace

  HertzEllipse hertz_ellipse(const double least_curvature, const double greatest_curvature,
                             const double effective_modulus, const double force)
  {
    FLANK_ASSERT(least_curvature > 0 && greatest_curvature >= least_curvature && force > 0,
                 "convex bodies pressed together");
    const double k = axis_ratio(greatest_curvature / least_curvature), k2 = k * k;
    // A = F R_D(0, k^2, 1) / (2 pi E* a^3)
    const double a = std::cbrt(force * ellint_rd(0.0, k2, 1.0) / (pi * effective_modulus * least_curvature));
    const double approach = 1.5 * force * ellint_rf(0.0, k2, 1.0) / (pi * a * effective_modulus);
    return { .long_half_axis = a,
             .short_half_axis = k * a,
             .max_pressure = 1.5 * force / (pi * k * a * a),
             .approach = approach,
             .stiffness = 1.5 * force / approach };
  }

  HertzLine hertz_line(const double radius, const double effective_modulus, const double load_per_length)
  {
    FLANK_ASSERT(radius > 0 && load_per_length > 0, "convex bodies pressed together");
    const double half_width = hertz_half_width(radius, effective_modulus, load_per_length);
    return { .half_width = half_width, .max_pressure = 2 * load_per_length / (pi * half_width) };
  }

  double hertz_half_width(const double radius, const double effective_modulus, const double load_per_length)
  {
    return std::sqrt(4 * load_per_length * radius / (pi * effective_modulus));
  }

  double effective_modulus(const double first_youngs_modulus, const double first_poissons_ratio,
                           const double second_youngs_modulus, const double second_poissons_ratio)
  {
    const auto plane = [](const double modulus, const double ratio) { return (1 - ratio * ratio) / modulus; };
    return 1 / (plane(first_youngs_modulus, first_poissons_ratio) +
                plane(second_youngs_modulus, second_poissons_ratio));
  }
} // namespace flank::half_space
