// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/hertz_stress.hpp"
#include "contact/half_space/subsurface.hpp"
#include "contact/solve/certificate.hpp"
#include "contact/solve/simplex_solver.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace flank;

namespace
{
  constexpr double E = 2.1e5, nu = 0.3, pi = 3.14159265358979323846;

  struct Hertz
  {
    ContactProblem problem;
    std::vector<half_space::Rectangle> cells;
  };

  /// Paraboloid with radii Rx, Ry on a steel half-space pair: cells of half-lengths hx, hy.
  Hertz paraboloid(const double rx, const double ry, const int nx, const int ny, const double width_x,
                   const double width_y)
  {
    Hertz h;
    const double hx = width_x / nx, hy = width_y / ny;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        h.cells.push_back({ -width_x + hx * (2 * i + 1), -width_y + hy * (2 * j + 1), hx, hy });
    const auto n = static_cast<Eigen::Index>(h.cells.size());
    h.problem.compliance.resize(n, n);
    h.problem.gap.resize(n);
    h.problem.lever = Eigen::VectorXd::Ones(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        const auto &c = h.cells[i];
        h.problem.gap[i] = (c.x * c.x + hx * hx / 3) / (2 * rx) +
                           (std::isinf(ry) ? 0 : (c.y * c.y + hy * hy / 3) / (2 * ry));
        for (Eigen::Index j = 0; j < n; ++j)
          h.problem.compliance(i, j) =
              2 * half_space::surface_compliance(E, nu) * half_space::mean_love_potential(h.cells[j], c);
      }
    return h;
  }
} // namespace

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

TEST(Contact, HertzPoint)
{
  const double R = 10, F = 500, effective = E / (1 - nu * nu) / 2, a = std::cbrt(3 * F * R / (4 * effective));
  const Hertz h = paraboloid(R, R, 31, 31, 1.3 * a, 1.3 * a);
  const auto solution = SimplexSolver(h.problem).solve(F);
  EXPECT_TRUE(certify(h.problem, solution).holds());
  EXPECT_NEAR(solution.theta, a * a / R, 1e-3 * a * a / R); // 24 cells across the contact
  EXPECT_NEAR(solution.force.maxCoeff() / h.cells[0].area(), 3 * F / (2 * pi * a * a),
              0.01 * 3 * F / (2 * pi * a * a));
  EXPECT_NEAR(solution.stiffness, 1.5 * F / solution.theta, 0.01 * solution.stiffness); // F ~ delta^1.5
}

TEST(Contact, HertzLine) // long strips, pressure in the middle
{
  const double R = 12.826, w = 100, effective = 206e3 / (1 - nu * nu) / 2 * (E / 206e3),
               a = std::sqrt(4 * w * R / (pi * effective));
  const double length = 20;
  const Hertz h = paraboloid(R, std::numeric_limits<double>::infinity(), 21, 21, 1.4 * a, length / 2);
  const auto s = SimplexSolver(h.problem).solve(w * length);
  EXPECT_TRUE(certify(h.problem, s).holds());
  // The ends carry more than the middle: compare with the line load found in the middle.
  double local = 0;
  for (int i = 0; i < 21; ++i)
    local += s.force[i * 21 + 10] / (2 * h.cells[0].b);
  const double local_width = std::sqrt(4 * local * R / (pi * effective));
  // 15 cells across: the central cell's mean is 0.3 % below the peak, a finite line departs by (a/length)^2.
  EXPECT_NEAR(s.force[10 * 21 + 10] / h.cells[0].area(), 2 * local / (pi * local_width),
              0.01 * 2 * local / (pi * local_width));
  EXPECT_NEAR(local, w, 0.1 * w);
}

TEST(Contact, HertzEllipse)
{
  // Rx = 4, Ry = 20: axis ratio k from (Ry/Rx) = (E(e)/k^2 ... ) solved numerically below; Johnson (1985)
  // eq. 4.26, 4.28.
  const double rx = 4, ry = 20, F = 300, effective = E / (1 - nu * nu) / 2;
  const auto elliptic = [](const double e2, double &K, double &Eint) {
    K = Eint = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i)
      {
        const double t = (i + 0.5) / n * pi / 2, d = std::sqrt(1 - e2 * std::sin(t) * std::sin(t));
        K += pi / 2 / n / d;
        Eint += pi / 2 / n * d;
      }
  };
  double low = 0.01, high = 1, K = 0, Ei = 0; // k = short/long axis
  for (int i = 0; i < 60; ++i)
    {
      const double k = 0.5 * (low + high);
      elliptic(1 - k * k, K, Ei);
      ((Ei / (k * k) - K) / (K - Ei) > ry / rx ? low : high) = k;
    }
  const double k = low, e2 = 1 - k * k;
  const double c3 =
      3 * F / (4 * effective) * std::sqrt(rx * ry) * 4 / (pi * e2) * std::sqrt((Ei / (k * k) - K) * (K - Ei));
  // c = sqrt(a b) from (ab)^{3/2} = (3 F Re / 4E*) F1^3, F1^3 = 4/(pi e^2) (b/a)^{3/2} sqrt(...).
  const double c = std::cbrt(c3 * std::pow(k, 1.5)), b = c * std::sqrt(k), a = c / std::sqrt(k);
  const Hertz h = paraboloid(rx, ry, 31, 31, 1.3 * b, 1.3 * a);
  const auto s = SimplexSolver(h.problem).solve(F);
  EXPECT_TRUE(certify(h.problem, s).holds());
  EXPECT_NEAR(s.force.maxCoeff() / h.cells[0].area(), 3 * F / (2 * pi * a * b),
              0.01 * 3 * F / (2 * pi * a * b)); // 24 cells across
}

// Johnson, Contact Mechanics (1985), 4.2: line 0.30028 p0 at 0.78615 a, von Mises 0.5577 p0 at 0.704 a; point
// 0.31002 p0 at 0.48086 a, where two principal stresses are equal and von Mises is twice the shear. For nu =
// 0.3.
TEST(SubsurfaceStress, BelowAHertzLine)
{
  const double R = 12.826, w = 100, effective = E / (1 - nu * nu) / 2,
               a = std::sqrt(4 * w * R / (pi * effective)), length = 200 * a;
  const Hertz h = paraboloid(R, std::numeric_limits<double>::infinity(), 31, 15, 1.2 * a, length / 2);
  const auto s = SimplexSolver(h.problem).solve(w * length);
  std::vector<half_space::LoadedRectangle> loads;
  double local = 0;
  for (std::size_t i = 0; i < h.cells.size(); ++i)
    {
      loads.push_back({ h.cells[i], s.force[static_cast<Eigen::Index>(i)] });
      if (i % 15 == 7)
        local += loads.back().force / (2 * h.cells[i].b);
    }
  const double width = std::sqrt(4 * local * R / (pi * effective)), peak = 2 * local / (pi * width);
  const auto below = half_space::greatest_below(loads, { { 0, 0 }, { 0.3 * width, 0 } }, 2 * a, nu);
  EXPECT_NEAR(below.shear, 0.30028 * peak, 0.01 * 0.30028 * peak);
  EXPECT_NEAR(below.shear_depth, 0.78615 * width, 0.01 * 0.78615 * width);
  EXPECT_NEAR(below.von_mises, 0.5577 * peak, 0.01 * 0.5577 * peak);
  EXPECT_NEAR(below.von_mises_depth, 0.704 * width, 0.01 * 0.704 * width);
}

TEST(SubsurfaceStress, BelowAHertzPoint)
{
  const double R = 10, F = 500, effective = E / (1 - nu * nu) / 2, a = std::cbrt(3 * F * R / (4 * effective)),
               peak = 3 * F / (2 * pi * a * a);
  const Hertz h = paraboloid(R, R, 31, 31, 1.15 * a, 1.15 * a);
  const auto s = SimplexSolver(h.problem).solve(F);
  std::vector<half_space::LoadedRectangle> loads;
  for (std::size_t i = 0; i < h.cells.size(); ++i)
    loads.push_back({ h.cells[i], s.force[static_cast<Eigen::Index>(i)] });
  const auto below = half_space::greatest_below(loads, { { 0, 0 } }, 2 * a, nu);
  EXPECT_NEAR(below.shear, 0.31002 * peak, 0.01 * 0.31002 * peak);
  EXPECT_NEAR(below.shear_depth, 0.48086 * a, 0.01 * 0.48086 * a);
  EXPECT_NEAR(below.von_mises, 2 * 0.31002 * peak, 0.01 * 0.62004 * peak);
  EXPECT_NEAR(below.von_mises_depth, 0.48086 * a, 0.01 * 0.48086 * a);
  // The same contact, 2^20 times smaller: the same stresses but for rounding, as deep in proportion; the
  // place of a maximum is good to the root of what its value is.
  const double small = std::ldexp(1.0, -20);
  for (half_space::LoadedRectangle &load : loads)
    {
      for (double *length : { &load.area.x, &load.area.y, &load.area.a, &load.area.b })
        *length *= small;
      load.force *= small * small;
    }
  const auto smaller = half_space::greatest_below(loads, { { 0, 0 } }, 2 * a * small, nu);
  EXPECT_NEAR(smaller.shear, below.shear, 1e-9 * below.shear);
  EXPECT_NEAR(smaller.shear_depth, below.shear_depth * small, 3e-5 * a * small);
  EXPECT_NEAR(smaller.von_mises_depth, below.von_mises_depth * small, 3e-5 * a * small);
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

TEST(Contact, EnergyIsTheWorkOfTheTorque)
{
  const Hertz h = paraboloid(10, 10, 21, 21, 0.35, 0.35);
  std::vector<double> torques;
  for (int i = 1; i <= 400; ++i)
    torques.push_back(500.0 * i * i / (400.0 * 400.0));
  const auto solutions = SimplexSolver(h.problem).sweep(torques);
  double work = 0.5 * torques[0] * (solutions[0].theta - h.problem.gap.minCoeff());
  for (std::size_t i = 1; i < solutions.size(); ++i)
    work += 0.5 * (torques[i] + torques[i - 1]) * (solutions[i].theta - solutions[i - 1].theta);
  const auto &last = solutions.back();
  const double elastic = 0.5 * last.force.dot(h.problem.compliance * last.force);
  EXPECT_NEAR(work, elastic, 1e-4 * elastic); // trapezoidal rule with 400 steps
}

TEST(Contact, ThousandRandomProblemsAreCertifiedAndTheSweepAgreesWithSingleSolves)
{
  std::mt19937 random(20);
  std::normal_distribution<> normal;
  for (int trial = 0; trial < 1000; ++trial)
    {
      const int n = 1 + trial % 40;
      Eigen::MatrixXd a(n, n);
      for (double &v : a.reshaped())
        v = normal(random);
      ContactProblem problem;
      problem.compliance = a * a.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
      problem.gap = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
      problem.lever = Eigen::VectorXd::NullaryExpr(n, [&] { return std::abs(normal(random)) + 0.01; });
      SimplexSolver solver(problem);
      const auto swept = solver.sweep({ 0.1, 1, 10 });
      for (const auto &s : swept)
        {
          ASSERT_TRUE(certify(problem, s).holds()) << trial << " " << certify(problem, s).worst();
          // Two routes to the unique rotation; 1e-9 allows for condition numbers up to 1e6 here.
          ASSERT_NEAR(s.theta, solver.solve(s.torque).theta, 1e-9 * (1 + std::abs(s.theta))) << trial;
        }
    }
}

TEST(Certificate, SeesEveryKindOfViolation)
{
  const Hertz h = paraboloid(10, 10, 9, 9, 0.3, 0.3);
  const auto s = SimplexSolver(h.problem).solve(500);
  EXPECT_TRUE(certify(h.problem, s).holds());
  auto bad = s;
  bad.theta *= 1.001;
  EXPECT_FALSE(certify(h.problem, bad).holds());
  bad = s;
  bad.force[40] *= 1.0001;
  EXPECT_FALSE(certify(h.problem, bad).holds());
  bad = s;
  bad.force[0] = -1;
  EXPECT_FALSE(certify(h.problem, bad).holds());
  bad = s;
  bad.torque = 501;
  EXPECT_FALSE(certify(h.problem, bad).holds());
  bad = s;
  bad.theta = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(certify(h.problem, bad).holds());
}

TEST(Certificate, RefusesAHundredMillionth)
{
  // The gate is 1e-10 of the scales: each of the four violated by 1e-8 of its own.
  const Hertz h = paraboloid(10, 10, 9, 9, 0.3, 0.3);
  const auto s = SimplexSolver(h.problem).solve(500);
  const double deflection = (h.problem.compliance * s.force).cwiseAbs().maxCoeff(), load = s.force.maxCoeff();
  EXPECT_LT(certify(h.problem, s).worst(), 1e-12);
  auto bad = s;
  bad.theta += 1e-8 * deflection / h.problem.lever.maxCoeff(); // loaded cells overlap, then part
  EXPECT_FALSE(certify(h.problem, bad).holds());
  EXPECT_NEAR(certify(h.problem, bad).penetration, 1e-8, 1e-9);
  bad.theta = s.theta - 1e-8 * deflection / h.problem.lever.maxCoeff();
  EXPECT_FALSE(certify(h.problem, bad).holds());
  EXPECT_GT(certify(h.problem, bad).complementarity, 1e-10);
  bad = s;
  bad.force[0] -= 1e-8 * load;
  EXPECT_FALSE(certify(h.problem, bad).holds());
  const double adhesion = 1e-8 * load / std::max(load, 500 / h.problem.lever.maxCoeff());
  EXPECT_NEAR(certify(h.problem, bad).adhesion, adhesion, 1e-6 * adhesion);
  bad = s;
  bad.torque *= 1 + 1e-8;
  EXPECT_FALSE(certify(h.problem, bad).holds());
  EXPECT_NEAR(certify(h.problem, bad).balance, 1e-8, 1e-9);
  auto shifted = h.problem; // an unloaded cell that is a little too high
  Eigen::Index last;
  (shifted.compliance * s.force + shifted.gap - s.theta * shifted.lever).maxCoeff(&last);
  shifted.gap[last] =
      s.theta * shifted.lever[last] - shifted.compliance.row(last).dot(s.force) - 1e-8 * deflection;
  EXPECT_FALSE(certify(shifted, s).holds());
}
