// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

/// Other ways to the same answer; they share no code with the solver.
namespace flank::reference
{
  struct Answer
  {
    bool found = false;
    double theta = 0;
    Eigen::VectorXd force;
  };

  /// Primal active set from a feasible force, every system solved from nothing in extended precision. torque
  /// != 0.
  Answer active_set(const ContactProblem &problem, double torque);

  /// All 2^n active sets, the one whose violation is least. n <= 12, torque != 0.
  Answer enumeration(const ContactProblem &problem, double torque);

  /// Projected conjugate gradients (Polonsky and Keer 1999, with levers). Well-conditioned problems, levers >
  /// 0, torque > 0.
  Answer projected_cg(const ContactProblem &problem, double torque);
} // namespace flank::reference
