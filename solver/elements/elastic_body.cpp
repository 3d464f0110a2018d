// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/elastic_body.hpp"

#include "mesh/base/errors.hpp"

#include <cmath>

namespace flank
{
  Eigen::MatrixXd ElasticBody::cell_stiffness(const int cell) const
  {
    Eigen::MatrixXd result;
    each_stiffness({ cell }, [&](int, const Eigen::MatrixXd &k) { result = k; });
    return result;
  }

  std::vector<double> lobatto_abscissas(const int degree)
  {
    FLANK_ASSERT(degree >= 1 && degree <= 3, std::to_string(degree));
    if (degree == 1)
      return { 0, 1 };
    if (degree == 2)
      return { 0, 0.5, 1 };
    return { 0, 0.5 - std::sqrt(0.05), 0.5 + std::sqrt(0.05), 1 };
  }
} // namespace flank
