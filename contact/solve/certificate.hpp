// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

namespace flank
{
  /// Whether a solution is one: recomputed from the unscaled data of all cells, in extended precision, by
  /// code that the solvers do not share. All scales have a floor, so it stays finite at T = 0.
  struct Certificate
  {
    double penetration = 0;     ///< greatest negative w over the deflection scale
    double adhesion = 0;        ///< greatest negative f over the load scale
    double complementarity = 0; ///< greatest |w| of a loaded cell over the deflection scale
    double balance = 0;         ///< |l.f - T| over |T| (or max|l| times the load scale)
    double gate = 0;            ///< what all four must not exceed

    double worst() const;
    bool holds() const { return worst() <= gate; } ///< false for NaN
  };

  /// The certificate of a solution, by the problem's own matrix alone. Its scales: deflection max(max|Cf|,
  /// max|g - theta l| over loaded cells, 1e-9 mm), load max(|T|/max|l|, max f, 1e-9 N); gate max(1e-10, 100
  /// eps max|g| / deflection scale).
  Certificate certify(const ContactProblem &problem, const ContactSolution &solution);

  /// The certificate of a solution with m rigid unknowns, its balance that of the worst of them: levers n x m
  /// [mm], moments m [N mm], theta m [rad].
  Certificate certify(const Eigen::MatrixXd &compliance, const Eigen::VectorXd &gap,
                      const Eigen::MatrixXd &levers, const Eigen::VectorXd &moments,
                      const Eigen::VectorXd &theta, const Eigen::VectorXd &force);
} // namespace flank
