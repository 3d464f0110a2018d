// SPDX-License-Identifier: GPL-2.0-or-later
// The half-space's closed forms: rectangles under pressure, and stress below Hertz's contacts.
#include "contact/half_space/half_space.hpp"
#include "contact/half_space/hertz_stress.hpp"
#include "tests/contact/steel.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace flank;

TEST(HalfSpace, LoveAgainstQuadratureOfBoussinesq)
{
  const double a = 0.1, b = 0.25;
  const Eigen::Vector3d p(0.13, -0.31, 0.2);
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  constexpr int n = 300;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      {
        const Eigen::Vector3d q =
            p - Eigen::Vector3d(a * ((2 * i + 1.0) / n - 1), b * ((2 * j + 1.0) / n - 1), 0);
        u += half_space::boussinesq_displacement(q, E, nu) / (n * n);
        s += half_space::boussinesq_stress(q, nu) / (n * n);
      }
  // Midpoint rule with 300 cells: its error falls with the square, 1e-5 at this distance.
  EXPECT_LT((u - half_space::love_displacement(a, b, p, E, nu)).norm(), 1e-5 * u.norm());
  EXPECT_LT((s - half_space::love_stress(a, b, p, nu)).norm(), 1e-5 * s.norm());
}

TEST(HalfSpace, LoveStressUnderThePatchIsThePressure)
{
  const Eigen::Matrix3d s = half_space::love_stress(0.1, 0.25, { 0.02, 0.05, 1e-9 }, nu);
  EXPECT_NEAR(s(2, 2), -1 / (4 * 0.1 * 0.25), 1e-6);
  EXPECT_NEAR(half_space::love_stress(0.1, 0.25, { 0.3, 0.05, 1e-9 }, nu)(2, 2), 0, 1e-6);
}

TEST(HalfSpace, SurfaceFormsAgreeAndKeepDigitsAtHighAspectRatio)
{
  const half_space::Rectangle s{ 0, 0, 1e-5, 1 };
  EXPECT_NEAR(half_space::surface_compliance(E, nu) *
                  half_space::love_potential({ 0, 0, 0.1, 0.2 }, 0.05, 0.3),
              half_space::love_displacement(0.1, 0.2, { 0.05, 0.3, 0 }, E, nu).z(), 1e-18);
  // A line's potential at its middle: (ln(2b/a) + 1) / b for a << b.
  EXPECT_NEAR(half_space::love_potential(s, 0, 0), std::log(2 / 1e-5) + 1, 1e-8);
}

TEST(HalfSpace, MeanPotentialAgainstQuadrature)
{
  const half_space::Rectangle s{ 0, 0, 0.02, 0.25 };
  for (const double dy : { 0.0, 0.45, 1.01, 2.5, 7.9 })
    for (const double dx : { 0.06, 0.3 })
      {
        const half_space::Rectangle t{ dx, dy, 0.03, 0.2 };
        double mean = 0;
        constexpr int n = 100;
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j)
            mean += half_space::love_potential(s, dx + t.a * ((2 * i + 1.0) / n - 1),
                                               dy + t.b * ((2 * j + 1.0) / n - 1)) /
                    (n * n);
        EXPECT_NEAR(half_space::mean_love_potential(s, t) / mean, 1, 5e-5)
            << dx << " " << dy; // the midpoint rule's own error beside the patch
        EXPECT_NEAR(half_space::mean_love_potential(s, t) / half_space::mean_love_potential(t, s), 1,
                    1e-11); // differences of sixteen terms
      }
}

// Cells of the lightest loads are as slender: a slice long at first, and as wide as a line contact is there.
// A strip's line potential ln(4b/|x|) - 1 + |x|/(2b), averaged over |x| of two strips: of one over itself
// (mean of ln|x|: ln(2a) - 3/2, of |x|: 2a/3), of one over its neighbour (ln(2a) - 3/2 + 2 ln 2, 2a).
TEST(HalfSpace, MeanPotentialsOfSlenderStrips)
{
  const double b = 0.7;
  for (const double slenderness : { 1e4, 1e6, 1e8, 1e10 })
    {
      const double a = b / slenderness,
                   tolerance = 2 * std::log(slenderness) / (slenderness * slenderness) + 1e-12; // rounding
      const half_space::Rectangle s{ 0, 0, a, b };
      const double own = half_space::mean_love_potential(s, s) * b;
      EXPECT_NEAR(own, std::log(2 * b / a) + 0.5 + a / (3 * b), tolerance) << slenderness;
      EXPECT_NEAR(half_space::mean_love_potential(s, { 2 * a, 0, a, b }) * b,
                  own - 2 * std::log(2.0) + 2 * a / (3 * b), tolerance)
          << slenderness;
      EXPECT_NEAR(half_space::mean_love_potential(s, { 0, 2 * b, a, b }) * b, std::log(2.0), a / b + 1e-12)
          << slenderness;
    }
}

TEST(HalfSpace, MeansOfManyPairsAreThoseOfEach)
{
  // Near and far pairs in turn, a number of them that no pack divides: every one in its own place.
  std::vector<half_space::RectanglePair> pairs;
  for (int k = 0; k < 203; ++k)
    pairs.push_back({ 0.01 * ((37 * k) % 101), 0.05 * ((53 * k) % 103), 0.01 + 0.0002 * (k % 7), 0.2, 0.03,
                      0.1 + 0.01 * (k % 11) });
  std::vector<double> mean(pairs.size());
  half_space::mean_love_potentials(pairs, mean);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    {
      const auto &p = pairs[k];
      EXPECT_DOUBLE_EQ(mean[k],
                       half_space::mean_love_potential({ 0, 0, p.a1, p.b1 }, { p.dx, p.dy, p.a2, p.b2 }))
          << k;
    }
}

TEST(HalfSpace, LineContactApproachRelativeToADepth) // the exact formula behind the classical split, any d/a
{
  const double a = 0.1, w = 100;
  for (const double d : { 0.05, 0.3, 1.0 })
    {
      // Hertz pressure as 2000 strips of a line so long that its ends do not matter (error (d/b)^2).
      constexpr int n = 2000;
      double value = 0;
      for (int i = 0; i < n; ++i)
        {
          const double x = a * ((2 * i + 1.0) / n - 1), b = 400,
                       line = 2 * w / (pi * a) * std::sqrt(1 - x * x / (a * a)) * 2 * a / n;
          value += 2 * b * line *
                   (half_space::love_displacement(a / n, b, { x, 0, 0 }, E, nu).z() -
                    half_space::love_displacement(a / n, b, { x, 0, d }, E, nu).z());
        }
      const double r = d / a,
                   exact = 2 * w * (1 - nu * nu) / (pi * E) *
                           (std::asinh(r) - nu / (1 - nu) * r * r * (std::sqrt(1 + 1 / (r * r)) - 1));
      EXPECT_NEAR(value, exact, 2e-4 * exact)
          << d; // strips at the ends of the semi-ellipse: n^-1.5, and 400 mm against rounding
    }
}

// Against Boussinesq's point forces, summed over the elliptical pressure: in r = sin(t) the integrand is
// smooth where the pressure ends, and the midpoint rule is right to its steps squared.
TEST(HertzStress, BelowAnEllipseIsTheSumOfPointForces)
{
  struct Scene
  {
    double a, b, depth, nu;
  };
  constexpr int n = 600;
  for (const auto &[a, b, depth, ratio] : { Scene{ 2, 1, 0.7, 0.3 }, Scene{ 1, 1, 0.48, 0.0 },
                                            Scene{ 1 + 1e-9, 1, 0.5, 0.1 }, Scene{ 3, 0.6, 0.3, 0.4999 } })
    {
      double along = 0, across = 0, normal = 0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          {
            const double t = pi / 2 * (i + 0.5) / n, angle = pi / 2 * (j + 0.5) / n, r = std::sin(t),
                         x = a * r * std::cos(angle), y = b * r * std::sin(angle), z = depth,
                         at = std::sqrt(x * x + y * y + z * z), flat2 = x * x + y * y,
                         force = 4 * a * b * r * std::cos(t) * std::cos(t) * (pi / 2 / n) * (pi / 2 / n);
            const auto sideways = [&, ratio = ratio](const double u, const double v) {
              return ((1 - 2 * ratio) / flat2 *
                          ((1 - z / at) * (u * u - v * v) / flat2 + z * v * v / std::pow(at, 3)) -
                      3 * z * u * u / std::pow(at, 5)) /
                     (2 * pi);
            };
            along += force * sideways(x, y);
            across += force * sideways(y, x);
            normal -= force * 3 * z * z * z / (2 * pi * std::pow(at, 5));
          }
      const half_space::HertzEllipse contact{
        .long_half_axis = a, .short_half_axis = b, .max_pressure = 1, .approach = 0, .stiffness = 0
      };
      const half_space::AxisStress stress = half_space::below(contact, depth, ratio);
      EXPECT_NEAR(stress.along, along, 3e-5);
      EXPECT_NEAR(stress.across, across, 3e-5);
      EXPECT_NEAR(stress.normal, normal, 3e-5);
    }
}

// Johnson (1985), table 4.1: greatest shear and its depth over the short half-axis, nu = 0.3. Its third digit
// is good to one: sums of point forces give 0.3221 at 0.596 where it has 0.323 at 0.590.
TEST(HertzStress, GreatestShearIsJohnsons)
{
  struct Row
  {
    double ratio, depth, shear;
  };
  for (const auto &[ratio, depth, shear] :
       { Row{ 0.2, 0.745, 0.322 }, Row{ 0.4, 0.665, 0.325 }, Row{ 0.6, 0.590, 0.323 },
         Row{ 0.8, 0.530, 0.317 }, Row{ 1.0, 0.480, 0.310 } })
    {
      const half_space::HertzEllipse contact{
        .long_half_axis = 3 / ratio, .short_half_axis = 3, .max_pressure = 100, .approach = 0, .stiffness = 0
      };
      const half_space::SubsurfaceStress below = half_space::greatest_below(contact, 0.3, 0.3);
      EXPECT_NEAR(below.shear, 100 * shear, 0.1) << ratio;
      EXPECT_NEAR(below.shear_depth, 3 * depth, 3 * 0.007) << ratio;
    }
  const half_space::HertzLine line{ .half_width = 3, .max_pressure = 100 };
  const half_space::SubsurfaceStress steel = half_space::greatest_below(line, 0.3, 0.3),
                                     mixed = half_space::greatest_below(line, 0.3, 0.1);
  EXPECT_NEAR(steel.shear, 30.028, 1e-3);
  // (1 + z^2)^(3/2) = z^3 + 2 z where the shear is greatest: exact, and to rounding, not to its root.
  EXPECT_NEAR(steel.shear_depth, 3 * std::sqrt((std::sqrt(5.0) - 1) / 2), 3e-11);
  EXPECT_GT(mixed.shear, 40);             // between pressure and nu times twice of it, near the surface
  EXPECT_NEAR(mixed.von_mises, 80, 1e-9); // of nu = 0.1, on the surface: 1 - 2 nu of the pressure
  EXPECT_NEAR(mixed.von_mises_depth, 0, 1e-6);
  for (const double ratio : { 1e-6, 1e-9, 1e-12 }) // so long that they are lines, but for their ratio
    {
      const half_space::HertzEllipse contact{
        .long_half_axis = 3 / ratio, .short_half_axis = 3, .max_pressure = 100, .approach = 0, .stiffness = 0
      };
      const half_space::SubsurfaceStress below = half_space::greatest_below(contact, 0.3, 0.3);
      EXPECT_NEAR(below.shear, steel.shear, 100 * ratio + 1e-8);
      EXPECT_NEAR(below.von_mises, steel.von_mises, 100 * ratio + 1e-8);
      EXPECT_NEAR(below.shear_depth, steel.shear_depth, 1e-5);
    }
}
