// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/SparseCore>

namespace flank
{
  /// Symmetric stiffness matrix, both triangles stored. [N/mm]
  using StiffnessMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
} // namespace flank
