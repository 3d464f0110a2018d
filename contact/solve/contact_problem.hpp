// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <vector>

namespace flank
{
  /// What is solved; no algorithm. n cells:
  ///     w = C f + g - theta l >= 0,   f >= 0,   f . w = 0,   l . f = T
  struct ContactProblem
  {
    Eigen::MatrixXd compliance; ///< C, n x n, symmetric positive definite [mm/N]
    Eigen::VectorXd gap;        ///< g, unloaded normal gap, either sign [mm]
    Eigen::VectorXd lever;      ///< l, approach per unit of theta [mm/rad = mm]

    Eigen::Index size() const { return gap.size(); }
  };

  struct ContactSolution
  {
    double           torque    = 0; ///< T [N mm]
    double           theta     = 0; ///< rigid rotation [rad]
    double           stiffness = 0; ///< exact tangent dT/dtheta [N mm/rad]
    Eigen::VectorXd  force;         ///< f [N]
    std::vector<int> active;        ///< cells with f basic, ascending
    int              pivots = 0;    ///< basis changes it took
  };

  /// Recomputed from the unscaled data of all cells by code the solver does not share.
  struct Certificate
  {
    double penetration     = 0; ///< greatest negative w over the deflection scale
    double adhesion        = 0; ///< greatest negative f over the load scale
    double complementarity = 0; ///< greatest |w| of a loaded cell over the deflection scale
    double balance         = 0; ///< |l.f - T| over |T| (or max|l| times the load scale)
    double gate            = 0; ///< what all four must not exceed

    double worst() const;
    bool   holds() const { return worst() <= gate; } ///< false for NaN
  };

  /// Scales: deflection max(max|Cf|, max|g - theta l| over loaded cells, 1e-9 mm), load max(|T|/max|l|, max f, 1e-9 N);
  /// gate max(1e-10, 100 eps max|g| / deflection scale).
  Certificate certify(const ContactProblem &problem, const ContactSolution &solution);
} // namespace flank
