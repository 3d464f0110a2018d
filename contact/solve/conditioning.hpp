// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>

namespace flank
{
  /// Condition number of a symmetric positive definite matrix in the 1-norm, its diagonal scaled to one
  /// (which the solvers do, and no unit changes): about how many times the rounding of the data comes out in
  /// what is solved with it. Estimated by Higham's method (1988; Eigen) on the Cholesky factor: at most the
  /// true one, rarely less than a third of it. 0 for an empty matrix, infinite for one that is not positive
  /// definite.
  double condition(const Eigen::Ref<const Eigen::MatrixXd> &matrix);
} // namespace flank
