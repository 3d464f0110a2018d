// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

#include <iosfwd>
#include <string>

namespace flank
{
  /// A contact problem as engineers send it to each other: white-space separated text, numbers to 17 digits,
  ///     LCP1 NAME   n N   T x   sym 0|1   l (N numbers)   g (N numbers)   C (N rows of N numbers)
  /// Forces are the unknowns.
  struct ProblemFile
  {
    std::string name;
    double torque = 0;
    ContactProblem problem;
  };

  /// Throws std::runtime_error with what is wrong and at which number.
  ProblemFile read_problem(std::istream &in);

  /// Writes what read_problem() reads back to the last bit. The program only reads; this stays beside the
  /// reading because it says the same format: tests and fuzzing check each by the other, and a problem that
  /// broke the solver is kept by it.
  void write_problem(std::ostream &out, const ProblemFile &file);

  /// status, theta, certificate, pivots and the forces p, 17 digits. "status FAILED" also for a solution
  /// whose certificate does not hold. Returns true for status OK.
  bool write_answer(std::ostream &out, const ContactProblem &problem, const ContactSolution &solution);
} // namespace flank
