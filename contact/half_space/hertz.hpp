// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank::half_space
{
  /// Hertz's contact of two bodies whose gap is A x^2 + B y^2 near the first touch: an ellipse, closed form.
  /// Source: Johnson (1985), sections 4.2 and 3.2, with Carlson's integrals (1995) in place of K and E, which
  /// lose digits on nearly circular ellipses.
  struct HertzEllipse
  {
    double long_half_axis, short_half_axis; ///< [mm]
    double max_pressure;                    ///< [MPa]
    double approach;                        ///< of points far away [mm]
    double stiffness;                       ///< d force / d approach [N/mm]
  };

  /// `least_curvature`, `greatest_curvature`: 2 A and 2 B, principal relative curvatures, both > 0 [1/mm];
  /// `effective_modulus`: E*, where 1/E* is the sum over both bodies of (1 - nu^2)/E [MPa]; force > 0 [N].
  HertzEllipse hertz_ellipse(double least_curvature, double greatest_curvature, double effective_modulus,
                             double force);

  /// Hertz's contact of two parallel cylinders. It has no approach: that of an endless
  /// line is infinite.
  struct HertzLine
  {
    double half_width;   ///< [mm]
    double max_pressure; ///< [MPa]
  };

  /// radius: relative, of both surfaces across the line [mm]; load_per_length > 0 [N/mm].
  HertzLine hertz_line(double radius, double effective_modulus, double load_per_length);

  /// The half-width of hertz_line() alone. [mm]
  double hertz_half_width(double radius, double effective_modulus, double load_per_length);

  /// E* of both bodies of a contact: 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2. [MPa]
  double effective_modulus(double first_youngs_modulus, double first_poissons_ratio,
                           double second_youngs_modulus, double second_poissons_ratio);
} // namespace flank::half_space
