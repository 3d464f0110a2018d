// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/wave_load.hpp"

#include "mesh/base/gauss.hpp"
#include "mesh/base/units.hpp"

#include <boost/math/special_functions/bessel.hpp>

#include <algorithm>
#include <cmath>

namespace flank::wedge
{
  namespace
  {
    /// Beyond this distance, in inverse wave numbers, nothing is left: exp(-40).
    constexpr double vanished = 40;

    double bessel_k(const int order, const double x)
    {
      using boost::math::policies::policy;
      using AsDouble =
          policy<boost::math::policies::promote_double<false>>; // long doubles take six times as long
      return boost::math::cyl_bessel_k(order, x, AsDouble());
    }

    /// Integrals over the depth from z on of K_0(R) and K_1(R) / R, R^2 = s^2 + z^2.
    struct DepthIntegrals
    {
      double k0 = 0, k1_over_r = 0;
    };

    DepthIntegrals below(const double s, const double z)
    {
      DepthIntegrals sum;
      const GaussRule &rule = gauss(6);
      for (double low = z, r = std::sqrt(s * s + z * z); r < vanished; r = std::sqrt(s * s + low * low))
        {
          const double length = std::min(r, 4.0); // both decay as fast as their distance, then by exp(-R)
          for (std::size_t q = 0; q < rule.point.size(); ++q)
            {
              const double depth = low + length * rule.point[q], at = std::sqrt(s * s + depth * depth),
                           weight = length * rule.weight[q];
              sum.k0 += weight * bessel_k(0, at);
              sum.k1_over_r += weight * bessel_k(1, at) / at;
            }
          low += length;
        }
      return sum;
    }
  } // namespace

  WaveStress wave_load_stress(const double s, const double z, const double nu)
  {
    const double r = std::hypot(s, z);
    if (r > vanished)
      return {};
    const double k0 = bessel_k(0, r), k1 = bessel_k(1, r), k2 = k0 + 2 * k1 / r;
    const double v_z = -2 * k1 * z / r, v_ss = -2 * k1 / r + 2 * s * s * k2 / (r * r),
                 v_zz = -2 * k1 / r + 2 * z * z * k2 / (r * r), v_sz = 2 * s * z * k2 / (r * r);
    const double k = 1 - 2 * nu;
    const DepthIntegrals depth = k != 0 ? below(s, z) : DepthIntegrals();
    const double chi_xx = 2 * depth.k0, chi_ss = -chi_xx - v_z, chi_xs = -2 * s * depth.k1_over_r;
    const double scale = 1 / (2 * units::pi);
    return { .xx = scale * (2 * nu * v_z - k * chi_xx + 2 * z * k0),
             .ss = scale * (2 * nu * v_z - k * chi_ss - z * v_ss),
             .zz = scale * (v_z - z * v_zz),
             .sz = scale * (-z * v_sz),
             .xs = scale * (-k * chi_xs - 2 * z * s * k1 / r),
             .xz = scale * (-2 * z * z * k1 / r) };
  }
} // namespace flank::wedge
