// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/gauss.hpp"

#include "mesh/base/errors.hpp"

#include <Eigen/Eigenvalues>

#include <array>
#include <cmath>
#include <string>

namespace flank
{
  namespace
  {
    constexpr int max_points = 8;

    /// Golub and Welsch (1969): abscissas are eigenvalues of the Legendre polynomials' three-term recurrence,
    /// weights the squared first components of its eigenvectors.
    GaussRule golub_welsch(const int n)
    {
      Eigen::VectorXd beside(n - 1);
      for (int k = 1; k < n; ++k)
        beside[k - 1] = k / std::sqrt(4.0 * k * k - 1);
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> recurrence;
      recurrence.computeFromTridiagonal(Eigen::VectorXd::Zero(n), beside);
      GaussRule rule;
      for (int k = 0; k < n; ++k)
        {
          const double first = recurrence.eigenvectors()(0, k);
          rule.point.push_back(0.5 + 0.5 * recurrence.eigenvalues()[k]);
          rule.weight.push_back(first * first);
        }
      return rule;
    }
  } // namespace

  const GaussRule &gauss(const int n)
  {
    FLANK_ASSERT(n >= 1 && n <= max_points, std::to_string(n));
    static const auto rules = [] {
      std::array<GaussRule, max_points + 1> all;
      for (int k = 1; k <= max_points; ++k)
        all[k] = golub_welsch(k);
      return all;
    }();
    return rules[n];
  }
} // namespace flank
