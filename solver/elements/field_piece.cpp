// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/field_piece.hpp"

namespace flank
{
  std::vector<Eigen::Vector3d> FieldPiece::points(const int dimension, const int degree)
  {
    std::vector<Eigen::Vector3d> result;
    for (int k = 0; k <= (dimension == 3 ? degree : 0); ++k)
      for (int j = 0; j <= degree; ++j)
        for (int i = 0; i <= degree; ++i)
          result.emplace_back(Eigen::Vector3d(i, j, k) / degree);
    return result;
  }
} // namespace flank
