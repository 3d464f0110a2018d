// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

namespace flank
{
  struct GaussRule
  {
    std::vector<double> point, weight; ///< on [0, 1]; the weights sum to 1
  };

  /// Gauss-Legendre rule with n = 1 .. 8 points: exact for polynomials of degree 2n - 1.
  const GaussRule &gauss(int n);
} // namespace flank
