// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/hertz_stress.hpp"
#include "contact/half_space/subsurface.hpp"
#include "contact/solve/certificate.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "tests/contact/steel.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace flank;

namespace
{
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

// However many cells share the load, each that carries some of it must touch.
TEST(Certificate, RefusesManyLoadedCellsThatStandApart)
{
  const Eigen::Index n = 1000;
  const ContactProblem springs{ Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n),
                                Eigen::VectorXd::Ones(n) };
  ContactSolution solution = SimplexSolver(springs).solve(n);
  EXPECT_TRUE(certify(springs, solution).holds());
  solution.theta -= 9e-8;
  EXPECT_FALSE(certify(springs, solution).holds());
}
