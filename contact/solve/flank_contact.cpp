// SPDX-License-Identifier: GPL-2.0-or-later
// flank-contact FILE.lcp: solves one contact problem of the format in problem_file.hpp ("-": standard input).
#include "contact/solve/problem_file.hpp"
#include "contact/solve/simplex_solver.hpp"

#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace
{
  constexpr const char *help =
      "flank-contact FILE.lcp    solves C f + g - theta l >= 0, f >= 0, f.(C f + g - theta l) = 0, l.f = T   "
      "(-: standard input)\n"
      "Input, white-space separated: LCP1 NAME, n N, T x, sym 0|1, l and N numbers, g and N numbers, C and N "
      "rows of N numbers.\n"
      "Output: status OK|INFEASIBLE|FAILED, theta, certificate (worst relative violation), pivots, p and N "
      "forces.\n"
      "Exit codes: 0 OK, 3 INFEASIBLE or FAILED, 2 a file that is not such a problem.\n";
} // namespace

int main(int argc, char **argv)
{
  using namespace flank;
  const std::string path = argc == 2 ? argv[1] : "";
  if (path == "--help" || path == "-h")
    {
      std::cout << help;
      return 0;
    }
  if (path.empty())
    {
      std::cerr << help;
      return 2;
    }
  ProblemFile file;
  try
    {
      std::ifstream stream(path);
      if (path != "-" && !stream)
        throw std::runtime_error("cannot be read");
      file = read_problem(path == "-" ? std::cin : stream);
    }
  catch (const std::exception &error)
    {
      std::cerr << path << ": " << error.what() << "\n";
      return 2;
    }
  if (!file.problem.symmetric)
    std::cerr << "C differs from its transpose by up to " << file.problem.asymmetry()
              << " of its greatest entry: solved with LU\n";
  const ContactSolution solution = SimplexSolver(file.problem).solve(file.torque);
  if (solution.regularisation > 0)
    std::cerr << "the active cells cannot be told apart (C is singular): " << solution.regularisation
              << " of the diagonal was added\n";
  return write_answer(std::cout, file.problem, solution) ? 0 : 3;
}
