// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/conditioning.hpp"

#include <Eigen/Cholesky>

#include <limits>

namespace flank
{
  double condition(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
  {
    if (matrix.size() == 0)
      return 0;
    const double none = std::numeric_limits<double>::infinity();
    if (!(matrix.diagonal().minCoeff() > 0))
      return none;
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * matrix * scale.asDiagonal());
    return factor.info() == Eigen::Success ? 1 / factor.rcond() : none;
  }
} // namespace flank
