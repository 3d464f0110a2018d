// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/certificate.hpp"
#include "contact/solve/problem_file.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "tests/contact/problem_zoo.hpp"
#include "tests/contact/rigid_body.hpp"

#include <gtest/gtest.h>

#include <random>
#include <sstream>

using namespace flank;

TEST(RigidBody, RotationAloneIsTheContactProblem)
{
  for (unsigned seed = 0; seed < 300; ++seed)
    {
      const zoo::Specimen z = zoo::random(50000 + seed, 1 + static_cast<int>(seed % 30));
      const ContactSolution s = SimplexSolver(z.problem).solve(z.torque);
      const auto r = solve_rigid_body(z.problem.compliance, z.problem.gap, z.problem.lever,
                                      Eigen::VectorXd::Constant(1, z.torque));
      ASSERT_EQ(r.status, Status::solved) << seed;
      ASSERT_NEAR(r.theta[0], s.theta, 1e-10 * std::max(std::abs(s.theta), 1e-3)) << seed;
    }
}

TEST(RigidBody, TiltsFreeAreCertifiedAndMoveTheLoadToTheMoments)
{
  std::mt19937 generator(60000);
  std::normal_distribution<> normal;
  int solved = 0, infeasible = 0;
  for (unsigned seed = 0; seed < 600; ++seed)
    {
      const int n = 4 + static_cast<int>(seed % 37), m = 2 + static_cast<int>(seed % 2);
      const zoo::Specimen z = zoo::random(60000 + seed, n);
      Eigen::MatrixXd levers(n, m);
      levers.col(0) = z.problem.lever;
      for (int c = 1; c < m; ++c)
        levers.col(c) = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(generator); });
      // Moments of some non-negative forces: carried by them at least.
      Eigen::VectorXd some =
          Eigen::VectorXd::NullaryExpr(n, [&] { return std::max(0.0, normal(generator)); });
      const Eigen::VectorXd moments =
          (seed % 10 == 9 ? -1.0 : 1.0) * (levers.transpose() * (some.array() + 0.01).matrix());
      const auto r = solve_rigid_body(z.problem.compliance, z.problem.gap, levers, moments);
      if (seed % 10 == 9) // every rotation lever is positive: a negative torque cannot be carried
        {
          EXPECT_NE(r.status, Status::solved) << seed;
          infeasible += r.status == Status::infeasible;
          continue;
        }
      ASSERT_EQ(r.status, Status::solved) << seed;
      const Certificate certificate =
          certify(z.problem.compliance, z.problem.gap, levers, moments, r.theta, r.force);
      ASSERT_TRUE(certificate.holds()) << seed << " " << certificate.worst();
      ++solved;
    }
  EXPECT_EQ(solved, 540);
  EXPECT_EQ(infeasible, 60);
}

TEST(RigidBody, AFreeTiltLevelsAMisalignedRoller)
{
  zoo::Specimen z = zoo::contact_lines(1, 15, 11, 50e3);
  Eigen::MatrixXd levers(z.problem.size(), 2);
  levers.col(0) = z.problem.lever;
  for (Eigen::Index i = 0; i < z.problem.size(); ++i)
    {
      const double y = static_cast<double>(i / 11) - 7;
      levers(i, 1) = y;
      z.problem.gap[i] += 0.002 * y;
    }
  const auto r = solve_rigid_body(z.problem.compliance, z.problem.gap, levers, Eigen::Vector2d(50e3, 0));
  ASSERT_EQ(r.status, Status::solved);
  EXPECT_NEAR(r.theta[1], 0.002, 1e-12); // the tilt takes the slope of the gap away
  EXPECT_TRUE(certify(z.problem.compliance, z.problem.gap, levers, Eigen::Vector2d(50e3, 0), r.theta, r.force)
                  .holds());
}

TEST(ProblemFile, WhatIsWrittenIsReadBack)
{
  const zoo::Specimen z = zoo::random(7, 5, 0.6);
  std::stringstream text;
  write_problem(text, { "seven", z.torque, z.problem });
  const ProblemFile back = read_problem(text);
  EXPECT_EQ(back.name, "seven");
  EXPECT_EQ(back.torque, z.torque);
  EXPECT_EQ(back.problem.compliance, z.problem.compliance);
  EXPECT_EQ(back.problem.gap, z.problem.gap);
  EXPECT_EQ(back.problem.lever, z.problem.lever);
}

TEST(ProblemFile, SaysWhatIsWrong)
{
  for (const char *bad :
       { "", "LCP2 x", "LCP1 x\nn 0", "LCP1 x\nn 1\nT nan", "LCP1 x\nn 1\nT 1\nsym 2",
         "LCP1 x\nn 1\nT 1\nsym 1\nl 1\ng 0\nC\n-1", "LCP1 x\nn 1\nT 1\nsym 1\nl 1\ng 0\nC\n1 2",
         "LCP1 x\nn 2\nT 1\nsym 1\nl 1 1\ng 0 0\nC\n1 0.5\n0.4 1", "LCP1 x\nn 2\nT 1\nsym 1\nl 1" })
    {
      std::stringstream text(bad);
      EXPECT_THROW(read_problem(text), std::runtime_error) << bad;
    }
}
