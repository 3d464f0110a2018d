// SPDX-License-Identifier: GPL-2.0-or-later
// Repeated solves of equal size take no memory from the heap: malloc itself is counted.
#include "contact/solve/simplex_solver.hpp"
#include "tests/contact/problem_zoo.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>

namespace
{
  std::atomic<long> taken{ 0 };
}

extern "C" void *__libc_malloc(std::size_t);
extern "C" void *malloc(std::size_t size)
{
  ++taken;
  return __libc_malloc(size);
}

TEST(SimplexSolver, RepeatedSolvesAllocateNothing)
{
  using namespace flank;
  zoo::Specimen z = zoo::contact_lines(3, 21, 11, 200e3);
  SimplexSolver solver(z.problem);
  ContactSolution solution;
  solver.solve(z.torque, {}, solution);
  const std::vector<int> start = solution.active;
  ASSERT_GT(start.size(), 150u); // several tiles of the factor
  solver.solve(0.9 * z.torque, start, solution);
  const long before = taken;
  for (const double part : { 1.0, 0.8, 0.5, 0.95 })
    {
      solver.set(z.problem);
      solver.solve(part * z.torque, start, solution);
      ASSERT_EQ(solution.status, Status::solved);
    }
  solver.solve(z.torque, {}, solution);
  EXPECT_EQ(taken - before, 0);
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(10); // the counter counts
  EXPECT_EQ(taken - before, 1) << seen[0];
}
