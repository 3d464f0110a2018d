// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/hertz_stress.hpp"

#include "contact/half_space/subsurface.hpp"
#include "mesh/base/least.hpp"

#include <boost/math/special_functions/ellint_rd.hpp>

#include <algorithm>
#include <cmath>

namespace flank::half_space
{
  using boost::math::ellint_rd;

  double AxisStress::shear() const
  {
    const auto [least, greatest] = std::minmax({ along, across, normal });
    return (greatest - least) / 2;
  }

  double AxisStress::von_mises() const
  {
    return half_space::von_mises(Eigen::Vector3d(along, across, normal).asDiagonal().toDenseMatrix());
  }

  AxisStress below(const HertzEllipse &contact, const double depth, const double nu)
  {
    const double a = contact.long_half_axis, b = contact.short_half_axis, zeta = depth / a,
                 zeta2 = zeta * zeta, ratio = b * b / (a * a), u = 1 / (1 + zeta2),
                 t = std::sqrt((ratio + zeta2) * u);
    // Differences of elliptic integrals over e^2 as Carlson's integrals: nothing cancels, and nothing is
    // divided by e or by the ratio of the axes.
    const double of_along = zeta * ellint_rd(zeta2, zeta2 + ratio, 1 + zeta2) / 3,
                 of_across = zeta * ellint_rd(zeta2, 1 + zeta2, zeta2 + ratio) / 3;
    const double along = -u / (2 * (1 + t)) + of_along, along_nu = -u / (t * (1 + t)) + of_across,
                 across = -u / (2 * t * (1 + t)) + of_across, across_nu = -u / (1 + t) + of_along;
    const double scale = contact.max_pressure * b / a;
    return { .along = 2 * scale * (along + nu * along_nu),
             .across = 2 * scale * (across + nu * across_nu),
             .normal = -scale * u / t };
  }

  AxisStress below(const HertzLine &contact, const double depth, const double nu)
  {
    const double zeta = depth / contact.half_width, root = std::sqrt(1 + zeta * zeta),
                 across = -contact.max_pressure * ((1 + 2 * zeta * zeta) / root - 2 * zeta),
                 normal = -contact.max_pressure / root;
    return { .along = nu * (across + normal), .across = across, .normal = normal };
  }

  namespace
  {
    double short_half_axis(const HertzEllipse &contact)
    {
      return contact.short_half_axis;
    }
    double short_half_axis(const HertzLine &contact)
    {
      return contact.half_width;
    }

    /// The slope over depth of a smooth `measure` of the stresses, by central differences of the sixth order
    /// that stay below the surface. Its zero is the place of a maximum to rounding, which values alone tell
    /// to the root of rounding.
    template <class Contact, class Measure>
    double slope(const Contact &contact, const double depth, const double nu, const Measure &measure)
    {
      const double half_axis = short_half_axis(contact), middle = std::max(depth, 1e-6 * half_axis),
                   apart = std::min(0.005 * half_axis, middle / 3);
      const auto difference = [&](const int k) {
        return measure(below(contact, middle + k * apart, nu)) -
               measure(below(contact, middle - k * apart, nu));
      };
      return (45 * difference(1) - 9 * difference(2) + difference(3)) / (60 * apart);
    }

    template <class Contact>
    double slope_of_von_mises(const Contact &contact, const double depth, const double nu)
    {
      return slope(contact, depth, nu, [](const AxisStress &stress) { return stress.von_mises(); });
    }

    /// The slope of the shear that the two outermost principal stresses at this depth make; the shear has a
    /// kink where another stress becomes an outermost one.
    template <class Contact>
    double slope_of_shear(const Contact &contact, const double depth, const double nu)
    {
      const AxisStress here = below(contact, depth, nu);
      const auto [least, greatest] =
          std::minmax({ &AxisStress::along, &AxisStress::across, &AxisStress::normal },
                      [&](const auto one, const auto other) { return here.*one < here.*other; });
      return slope(contact, depth, nu, [least = least, greatest = greatest](const AxisStress &stress) {
        return (stress.*greatest - stress.*least) / 2;
      });
    }
  } // namespace

  template <class Contact>
  SubsurfaceStress greatest_below(const Contact &contact, const double first_nu, const double second_nu)
  {
    constexpr int samples = 24, bits = 26;
    const double step = 2 * short_half_axis(contact) / samples;
    SubsurfaceStress result;
    const auto search = [&](const double nu, double (AxisStress::*measure)() const, const auto &slope_of,
                            double &value, double &at_depth) {
      const auto of = [&](const double depth) { return (below(contact, depth, nu).*measure)(); };
      int best = 0;
      for (int k = 1; k <= samples; ++k)
        if (of(k * step) > of(best * step))
          best = k;
      const auto [depth, less] = least_where_flat([&](const double at) { return -of(at); },
                                                  [&](const double at) { return -slope_of(contact, at, nu); },
                                                  std::max(0, best - 1) * step, (best + 1) * step, bits);
      for (const double place : { best * step, depth })
        if (of(place) > value)
          value = of(place), at_depth = place;
    };
    for (const double nu : { first_nu, second_nu })
      {
        search(nu, &AxisStress::shear, slope_of_shear<Contact>, result.shear, result.shear_depth);
        search(nu, &AxisStress::von_mises, slope_of_von_mises<Contact>, result.von_mises,
               result.von_mises_depth);
      }
    return result;
  }

  template SubsurfaceStress greatest_below(const HertzEllipse &, double, double);
  template SubsurfaceStress greatest_below(const HertzLine &, double, double);
} // namespace flank::half_space
