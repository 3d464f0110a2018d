// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/certificate.hpp"
#include "contact/solve/conditioning.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "tests/contact/problem_zoo.hpp"
#include "tests/contact/reference_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace flank;

namespace
{
  /// The corner or end of the curve from which a torque's piece goes on.
  const Breakpoint &below(const TorqueCurve &curve, const double torque)
  {
    return *(std::upper_bound(curve.points.begin() + 1, curve.points.end() - 1, torque,
                              [](const double t, const Breakpoint &p) { return t < p.torque; }) -
             1);
  }

  /// The rotation on the curve's pieces. [rad]
  double theta_at(const TorqueCurve &curve, const double torque)
  {
    const Breakpoint &from = below(curve, torque);
    return from.stiffness > 0 ? from.theta + (torque - from.torque) / from.stiffness : from.theta;
  }

  /// dtheta/dl: what a longer lever does is what a lesser gap does, theta at a time, and it takes the force's
  /// share of the torque over. All cells. [rad/mm]
  Eigen::VectorXd theta_by_lever(const ContactSolution &s, const Sensitivities &exact)
  {
    return -s.force / s.stiffness - s.theta * exact.theta_by_gap;
  }

  double deflection_scale(const ContactProblem &p, const ContactSolution &s)
  {
    return std::max((p.compliance * s.force).cwiseAbs().maxCoeff(), 1e-300) /
           std::max(p.lever.cwiseAbs().maxCoeff(), 1e-300);
  }
} // namespace

TEST(Zoo, EverySpecimenIsCertifiedAndAgreesWithTheReference)
{
  for (const auto &[name, problem, torque, well_posed] : zoo::all())
    {
      SimplexSolver solver(problem);
      const ContactSolution s = solver.solve(torque);
      ASSERT_EQ(s.status, Status::solved) << name;
      EXPECT_TRUE(certify(problem, s).holds()) << name << " " << certify(problem, s).worst();
      EXPECT_LE(s.pivots, 4 * problem.size() + 100) << name; // measured: at most about two a cell
      if (torque == 0)
        continue;
      const auto other = reference::active_set(problem, torque);
      ASSERT_TRUE(other.found) << name;
      // theta to 1e-10 of the larger of itself and the elastic approach; singular problems to what their
      // kernel leaves.
      const double size = std::max(std::abs(s.theta), deflection_scale(problem, s));
      EXPECT_NEAR(s.theta, other.theta, (well_posed ? 1e-10 : 1e-8) * size) << name;
      if (!well_posed)
        continue;
      EXPECT_LT((s.force - other.force).cwiseAbs().maxCoeff(), 1e-7 * s.force.maxCoeff()) << name;
    }
}

TEST(Zoo, ResultsDoNotDependOnTheStart)
{
  for (const auto &[name, problem, torque, well_posed] : zoo::all())
    {
      SimplexSolver solver(problem);
      const ContactSolution cold = solver.solve(torque);
      std::vector<int> all(problem.size());
      for (Eigen::Index i = 0; i < problem.size(); ++i)
        all[i] = static_cast<int>(i);
      for (const std::vector<int> &start :
           { cold.active, all, std::vector<int>{ static_cast<int>(problem.size()) - 1 } })
        {
          const ContactSolution warm = solver.solve(torque, start);
          ASSERT_EQ(warm.status, Status::solved) << name;
          EXPECT_TRUE(certify(problem, warm).holds()) << name;
          if (warm.active == cold.active)
            EXPECT_EQ(warm.theta, cold.theta) << name; // to the last bit
          else
            EXPECT_NEAR(warm.theta, cold.theta,
                        1e-8 * std::max(std::abs(cold.theta), deflection_scale(problem, cold)))
                << name;
        }
    }
}

TEST(Zoo, TheFinitePathAloneSolvesEverySpecimen)
{
  for (const auto &[name, problem, torque, well_posed] : zoo::all())
    {
      SimplexSolver solver(problem);
      const ContactSolution fast = solver.solve(torque), finite = solver.solve_by_path(torque);
      ASSERT_EQ(finite.status, Status::solved) << name;
      EXPECT_TRUE(certify(problem, finite).holds()) << name << " " << certify(problem, finite).worst();
      EXPECT_LE(finite.pivots, 2 * problem.size() + 100) << name;
      EXPECT_NEAR(finite.theta, fast.theta,
                  (well_posed ? 1e-10 : 1e-8) *
                      std::max(std::abs(fast.theta), deflection_scale(problem, fast)))
          << name;
      if (name == "three contact lines") // on contact-type compliance: one pivot an active cell
        {
          EXPECT_LE(finite.pivots, 1.02 * static_cast<double>(finite.active.size()));
        }
    }
}

TEST(Zoo, SweepAndCurveAgreeWithSingleSolves)
{
  for (const auto &[name, problem, torque, well_posed] : zoo::all())
    {
      if (torque <= 0)
        continue;
      SimplexSolver solver(problem);
      std::vector<double> torques = { torque };
      for (int i = 1; i <= 20; ++i)
        torques.push_back(torque * i / 21.0);
      const auto swept = solver.sweep(torques);
      for (const ContactSolution &s : swept)
        {
          ASSERT_EQ(s.status, Status::solved) << name;
          EXPECT_TRUE(certify(problem, s).holds())
              << name << " at " << s.torque << ": " << certify(problem, s).worst();
          const ContactSolution single = solver.solve(s.torque);
          EXPECT_NEAR(s.theta, single.theta,
                      (well_posed ? 1e-10 : 1e-8) * std::max(std::abs(s.theta), deflection_scale(problem, s)))
              << name;
        }
      if (!well_posed)
        continue;
      const TorqueCurve curve = solver.curve(0.1 * torque, torque);
      ASSERT_EQ(curve.status, Status::solved) << name;
      double before = -1e300;
      for (const Breakpoint &point : curve.points)
        {
          EXPECT_GE(point.torque, before * (1 - 1e-9)) << name;
          before = point.torque;
        }
      for (const ContactSolution &s : swept)
        if (s.torque >= 0.1 * torque)
          {
            EXPECT_NEAR(theta_at(curve, s.torque), s.theta,
                        1e-10 * std::max(std::abs(s.theta), deflection_scale(problem, s)))
                << name;
            EXPECT_NEAR(below(curve, s.torque).stiffness, s.stiffness, 1e-8 * s.stiffness) << name;
          }
    }
}

TEST(Zoo, SweepsDoNotDependOnTheStart)
{
  std::mt19937 random(5);
  for (const auto &[name, problem, torque, well_posed] : zoo::all())
    {
      if (torque <= 0 || !well_posed)
        continue;
      SimplexSolver solver(problem);
      const std::vector<double> torques = { 0.3 * torque, torque, 0.7 * torque, 0.9 * torque, 0.05 * torque };
      const ContactSolution greatest = solver.solve(torque);
      std::vector<int> all(problem.size());
      std::iota(all.begin(), all.end(), 0);
      // Guesses of every kind: too much and in no order, too little, the wrong cell, the right ones with the
      // least sure first.
      std::vector<std::vector<int>> starts = {
        all, { greatest.active.front() }, { static_cast<int>(problem.size()) - 1 }, greatest.active
      };
      std::shuffle(starts[0].begin(), starts[0].end(), random);
      std::sort(starts[3].begin(), starts[3].end(),
                [&](int a, int b) { return greatest.force[a] < greatest.force[b]; });
      for (const std::vector<int> &start : starts)
        {
          const auto swept = solver.sweep(torques, start);
          for (std::size_t t = 0; t < torques.size(); ++t)
            {
              const ContactSolution single = solver.solve(torques[t]);
              ASSERT_EQ(swept[t].status, Status::solved) << name;
              EXPECT_TRUE(certify(problem, swept[t]).holds())
                  << name << ": " << certify(problem, swept[t]).worst();
              // 1e-10, or what the rounding of the gaps leaves of the rotation at a billionth of the torque.
              const double size = std::max(std::abs(single.theta), deflection_scale(problem, single));
              EXPECT_NEAR(swept[t].theta, single.theta,
                          std::max(1e-10 * size, 1e-16 * problem.gap.cwiseAbs().maxCoeff()))
                  << name;
            }
        }
    }
}

TEST(Random, ThousandsAreCertifiedAndAgreeWithIndependentSolvers)
{
  int enumerated = 0, compared = 0;
  for (unsigned seed = 0; seed < 4000; ++seed)
    {
      const int n = 1 + static_cast<int>(seed % 40);
      const zoo::Specimen z = zoo::random(seed, n, seed % 3 == 0 ? 1 : 0.7);
      SimplexSolver solver(z.problem);
      for (const double torque : { z.torque, 100 * z.torque })
        {
          const ContactSolution s = solver.solve(torque);
          ASSERT_EQ(s.status, Status::solved) << seed;
          ASSERT_TRUE(certify(z.problem, s).holds()) << seed << " " << certify(z.problem, s).worst();
          ASSERT_LE(s.pivots, 40 * n + 40) << seed;
          const auto other =
              n <= 8 ? reference::enumeration(z.problem, torque) : reference::active_set(z.problem, torque);
          ASSERT_TRUE(other.found) << seed;
          ASSERT_NEAR(s.theta, other.theta,
                      1e-10 * std::max(std::abs(s.theta), deflection_scale(z.problem, s)))
              << seed;
          ASSERT_LT((s.force - other.force).cwiseAbs().maxCoeff(), 1e-8 * (s.force.maxCoeff() + 1e-300))
              << seed;
          (n <= 8 ? enumerated : compared)++;
        }
    }
  EXPECT_GT(enumerated, 1000);
  EXPECT_GT(compared, 5000);
}

TEST(Random, EnumerationUpToTwelveCells)
{
  for (unsigned seed = 0; seed < 12; ++seed)
    {
      const zoo::Specimen z = zoo::random(10000 + seed, 12, 0.7);
      const auto other = reference::enumeration(z.problem, z.torque);
      ASSERT_TRUE(other.found);
      EXPECT_NEAR(SimplexSolver(z.problem).solve(z.torque).theta, other.theta,
                  1e-10 * std::max(1.0, std::abs(other.theta)));
    }
}

TEST(Random, ProjectedConjugateGradientsAgreeWhereWellConditioned)
{
  for (unsigned seed = 0; seed < 50; ++seed)
    {
      zoo::Specimen z = zoo::random(20000 + seed, 30);
      z.problem.compliance.diagonal().array() += 1;
      const auto other = reference::projected_cg(z.problem, z.torque);
      ASSERT_TRUE(other.found) << seed;
      EXPECT_NEAR(SimplexSolver(z.problem).solve(z.torque).theta, other.theta,
                  1e-10 * std::max(1.0, std::abs(other.theta)))
          << seed;
    }
}

TEST(Random, NegativeTorqueIsTheMirrorImage)
{
  for (unsigned seed = 0; seed < 300; ++seed)
    {
      const zoo::Specimen z = zoo::random(30000 + seed, 20, 0.6);
      ContactProblem mirror = z.problem;
      mirror.lever = -mirror.lever;
      const ContactSolution a = SimplexSolver(z.problem).solve(z.torque),
                            b = SimplexSolver(mirror).solve(-z.torque);
      ASSERT_EQ(a.theta, -b.theta);
      ASSERT_EQ(a.force, b.force);
      ASSERT_TRUE(certify(mirror, b).holds());
    }
}

TEST(Random, SensitivitiesAreDifferenceQuotients)
{
  for (unsigned seed = 0; seed < 60; ++seed)
    {
      zoo::Specimen z = zoo::random(40000 + seed, 15, 0.8);
      if (seed % 2)
        {
          for (Eigen::Index j = 0; j < 15; ++j)
            for (Eigen::Index i = 0; i < j; ++i)
              z.problem.compliance(i, j) *= 1 + 0.02 * std::sin(5.0 * i + j);
          z.problem.symmetric = false;
        }
      for (const double sense : { 1.0, -1.0 })
        {
          ContactProblem p = z.problem;
          p.lever = sense * p.lever;
          const double torque = sense * z.torque;
          SimplexSolver solver(p);
          const auto s = solver.solve(torque);
          const auto exact = solver.sensitivities(s);
          const auto perturbed = [&](const auto &change, const double by) {
            ContactProblem q = p;
            change(q, by);
            return SimplexSolver(q).solve(torque, s.active);
          };
          const double h = 1e-6;
          for (Eigen::Index k = 0; k < 15; ++k)
            {
              for (const bool gap : { true, false })
                {
                  const auto change = [&](ContactProblem &q, const double by) {
                    (gap ? q.gap : q.lever)[k] += by;
                  };
                  const auto plus = perturbed(change, h), minus = perturbed(change, -h);
                  if (plus.active != s.active || minus.active != s.active)
                    continue; // a corner of the piecewise linear answer
                  EXPECT_NEAR((plus.theta - minus.theta) / (2 * h),
                              (gap ? exact.theta_by_gap : theta_by_lever(s, exact))[k],
                              1e-6 * (1 + std::abs(s.theta)) *
                                  (1 + exact.theta_by_gap.cwiseAbs().maxCoeff()) * (1 + s.force.maxCoeff()))
                      << seed << " " << k << " " << gap; // rounding over 2 h, and h^2
                }
            }
          const auto plus = solver.solve(torque * (1 + 1e-6), s.active),
                     minus = solver.solve(torque * (1 - 1e-6), s.active);
          if (plus.active != s.active || minus.active != s.active)
            continue;
          EXPECT_LT(
              ((plus.force - minus.force) / (2e-6 * torque) - exact.force_by_torque).cwiseAbs().maxCoeff(),
              1e-7 * (1 + exact.force_by_torque.cwiseAbs().maxCoeff()) *
                  (1 + s.force.maxCoeff() / std::abs(torque)));
          EXPECT_NEAR((plus.theta - minus.theta) / (2e-6 * torque), 1 / s.stiffness,
                      1e-8 / s.stiffness * (1 + std::abs(s.theta) * s.stiffness / std::abs(torque)));
        }
    }
}

TEST(Status, WhatCannotBeCarriedIsInfeasible)
{
  ContactProblem p{ Eigen::MatrixXd::Identity(3, 3), Eigen::Vector3d(0, 0.1, 0.2),
                    Eigen::Vector3d(-1, 0, -2) };
  SimplexSolver solver(p);
  EXPECT_EQ(solver.solve(1).status, Status::infeasible);
  EXPECT_EQ(solver.solve(-1).status, Status::solved);
  p.lever.setZero();
  EXPECT_EQ(SimplexSolver(p).solve(1).status, Status::infeasible);
  EXPECT_EQ(SimplexSolver(p).solve(0).status, Status::solved);
  EXPECT_FALSE(certify(p, SimplexSolver(p).solve(1)).holds());
}

TEST(Status, WithoutTorqueTheRotationIsThatOfFirstTouch)
{
  const ContactProblem p{ Eigen::MatrixXd::Identity(3, 3), Eigen::Vector3d(0.3, 0.1, 0.5),
                          Eigen::Vector3d(1, 0.5, -1) };
  const ContactSolution s = SimplexSolver(p).solve(0);
  EXPECT_EQ(s.theta, 0.2);
  EXPECT_EQ(s.force.maxCoeff(), 0);
  EXPECT_TRUE(certify(p, s).holds());
  EXPECT_EQ(certify(p, s).worst(), 0);
}

TEST(Status, AnIndefiniteComplianceFailsAndSaysSo)
{
  ContactProblem p{ Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1) };
  p.compliance(0, 1) = p.compliance(1, 0) = 2;
  const ContactSolution s = SimplexSolver(p).solve(1);
  EXPECT_TRUE(s.status == Status::failed || certify(p, s).holds()); // a vertex may solve it all the same
}

TEST(Random, HostileProblemsAreSolvedAndCertified)
{
  // One in 40,000 of these was seen to fail, and said so; none of the seeds here.
  for (unsigned seed = 0; seed < 3000; ++seed)
    {
      const zoo::Specimen z = zoo::hostile(seed);
      SimplexSolver solver(z.problem);
      for (const ContactSolution &s : { solver.solve(z.torque), solver.solve_by_path(z.torque) })
        {
          ASSERT_EQ(s.status, Status::solved) << seed;
          ASSERT_TRUE(certify(z.problem, s).holds()) << seed << " " << certify(z.problem, s).worst();
          ASSERT_LE(s.pivots, 50 * z.problem.size() + 1000) << seed;
        }
    }
}

TEST(Random, TiesOfSmallIntegersNeverCycle)
{
  // Integer data: ties at every step, singular blocks, cells that touch exactly.
  std::mt19937 generator(70000);
  for (int trial = 0; trial < 3000; ++trial)
    {
      const int n = 1 + trial % 14;
      std::uniform_int_distribution<int> entry(0, 2), gap(-2, 2);
      Eigen::MatrixXd a =
          Eigen::MatrixXd::NullaryExpr(n, 1 + trial % 5 + n / 2, [&] { return entry(generator); });
      ContactProblem p{ a * a.transpose(), Eigen::VectorXd::NullaryExpr(n, [&] { return gap(generator); }),
                        Eigen::VectorXd::NullaryExpr(n, [&] { return entry(generator); }) };
      p.compliance.diagonal().array() += trial % 2 ? 1 : 1e-3;
      p.lever[0] = 1;
      for (const double torque : { 1.0, 3.0, 0.0, 100.0 })
        {
          const ContactSolution s = SimplexSolver(p).solve(torque);
          ASSERT_EQ(s.status, Status::solved) << trial << " " << torque;
          ASSERT_TRUE(certify(p, s).holds()) << trial << " " << torque << " " << certify(p, s).worst();
          ASSERT_LE(s.pivots, 40 * n + 40);
          const ContactSolution finite = SimplexSolver(p).solve_by_path(torque);
          ASSERT_EQ(finite.status, Status::solved) << trial << " " << torque;
          ASSERT_TRUE(certify(p, finite).holds())
              << trial << " " << torque << " " << certify(p, finite).worst();
          ASSERT_LE(finite.pivots, 40 * n + 40);
        }
    }
}

TEST(Condition, OfMatricesWhoseInverseIsKnown)
{
  EXPECT_EQ(condition(Eigen::MatrixXd(0, 0)), 0);
  EXPECT_DOUBLE_EQ(condition(Eigen::Vector3d(1e-9, 4, 1e6).asDiagonal().toDenseMatrix()), 1); // of units
  for (const double r : { 0.5, -0.9, 0.999999 })
    for (const double unit : { 1.0, 1e-6 })
      {
        Eigen::Matrix2d m;
        m << 1, r * unit, r * unit, unit * unit;
        EXPECT_NEAR(condition(m) * (1 - std::abs(r)), 1 + std::abs(r), 1e-9) << r << " " << unit;
      }
  EXPECT_TRUE(std::isinf(condition((Eigen::Matrix2d() << 1, 2, 2, 1).finished())));
  EXPECT_TRUE(std::isinf(condition(Eigen::Matrix2d::Zero())));
  // Hilbert's, with an inverse in extended precision.
  Eigen::Matrix<long double, 7, 7> hilbert;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j)
      hilbert(i, j) = std::sqrt((2.0L * i + 1) * (2.0L * j + 1)) / (i + j + 1);
  const auto norm = [](const auto &m) {
    return static_cast<double>(m.cwiseAbs().colwise().sum().maxCoeff());
  };
  const double exact = norm(hilbert) * norm(hilbert.inverse().eval()),
               found = condition(hilbert.cast<double>().eval());
  EXPECT_LE(found, exact * (1 + 1e-6)); // the scaled matrix is rounded: 1e-16 times its condition of 1e8
  EXPECT_GE(found, exact / 3);
}

TEST(Random, UnsymmetricIsCertifiedAndAgrees)
{
  for (unsigned seed = 0; seed < 500; ++seed)
    {
      zoo::Specimen z = zoo::random(80000 + seed, 2 + static_cast<int>(seed % 30), 0.8);
      for (Eigen::Index j = 0; j < z.problem.size(); ++j)
        for (Eigen::Index i = 0; i < j; ++i)
          z.problem.compliance(i, j) += 0.02 * std::sin(3.0 * i + 5.0 * j);
      z.problem.symmetric = false;
      const ContactSolution s = SimplexSolver(z.problem).solve(z.torque);
      ASSERT_EQ(s.status, Status::solved) << seed;
      ASSERT_TRUE(certify(z.problem, s).holds()) << seed << " " << certify(z.problem, s).worst();
      if (z.problem.size() <= 9)
        {
          const auto other = reference::enumeration(z.problem, z.torque);
          ASSERT_TRUE(other.found) << seed;
          ASSERT_NEAR(s.theta, other.theta,
                      1e-10 * std::max(std::abs(s.theta), deflection_scale(z.problem, s)))
              << seed;
        }
    }
}
