// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <vector>

namespace flank
{
  /// What is solved; no algorithm. n cells, one rigid unknown theta:
  ///     w = C f + g - theta l >= 0,   f >= 0,   f . w = 0,   l . f = T
  struct ContactProblem
  {
    Eigen::MatrixXd compliance; ///< C, n x n, column k: normal displacements for a unit force on cell k
                                ///< [mm/N]; positive definite
    Eigen::VectorXd gap;        ///< g, unloaded normal gap, either sign [mm]
    Eigen::VectorXd lever;      ///< l, approach per unit of theta, either sign [mm/rad = mm]
    bool symmetric = true;      ///< false: C differs from its transpose, and LU takes the place of Cholesky

    Eigen::Index size() const { return gap.size(); }

    /// max|C - C'| / max|C|
    double asymmetry() const;
  };

  enum class Status
  {
    solved,
    infeasible, ///< no forces f >= 0 have the torque asked for
    failed      ///< the pivot bound was reached, or C is not positive definite
  };

  struct ContactSolution
  {
    Status status = Status::failed;
    double torque = 0; ///< T [N mm]
    double theta = 0;  ///< rigid rotation [rad]; where nothing is loaded: at first touch in the sense of T (T
                       ///< = 0: as T > 0)
    double stiffness = 0;    ///< exact tangent dT/dtheta [N mm/rad]
    Eigen::VectorXd force;   ///< f [N]
    std::vector<int> active; ///< basic cells (w = 0), ascending
    int pivots = 0;          ///< basis changes it took
    double regularisation =
        0; ///< relative addition to the diagonal of C that a singular active block needed; 0 as a rule
  };
} // namespace flank
