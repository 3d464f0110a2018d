// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/problem_file.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "validation/fuzz/harness.hpp"

#include <sstream>
#include <stdexcept>

namespace flank::fuzz
{
  std::string take_lcp(const std::string_view bytes)
  {
    std::istringstream in{ std::string(bytes) };
    ProblemFile file;
    try
      {
        file = read_problem(in);
      }
    catch (const std::runtime_error &error)
      {
        return error.what();
      }
    if (file.problem.size() > 12)
      return "";
    std::ostringstream out;
    write_answer(out, file.problem, SimplexSolver(file.problem).solve(file.torque));
    write_problem(out, file);
    return "";
  }
} // namespace flank::fuzz
