// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

namespace flank
{
  /// Several rigid unknowns, such as rotation and tilts: levers L is n x m, one column an unknown,
  ///     w = C f + g - L theta >= 0,   f >= 0,   f . w = 0,   L' f = T
  struct RigidBodySolution
  {
    Status status = Status::failed;
    Eigen::VectorXd theta; ///< m [rad, or the unit that makes L theta a length]
    Eigen::VectorXd force; ///< n [N]
    std::vector<int> active;
    int pivots = 0;
  };

  /// Solves for one load: moments T of length m. C symmetric positive definite, m small. Block principal
  /// pivoting on the bordered system; where that does not end, the unknowns are held by springs, which makes
  /// it a plain problem the finite path solves, and the springs are softened until the active set is that
  /// without them. Certify with certify(C, g, L, T, theta, force).
  RigidBodySolution solve_rigid_body(const Eigen::MatrixXd &compliance, const Eigen::VectorXd &gap,
                                     const Eigen::MatrixXd &levers, const Eigen::VectorXd &moments,
                                     const std::vector<int> &start = {});
} // namespace flank
