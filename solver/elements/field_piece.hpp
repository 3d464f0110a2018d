// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <string>
#include <vector>

namespace flank
{
  /// Data on hexahedra or quadrilaterals of one polynomial degree, for ParaView. Values belong to a cell's
  /// own points: they may jump between cells.
  struct FieldPiece
  {
    struct Array
    {
      std::string name; ///< with unit
      int components;   ///< 1, 3 (vector) or 9 (tensor, row by row)
    };

    int dimension = 3; ///< of the cells: 3 hexahedra, 2 quadrilaterals
    int degree = 1;
    std::vector<Array> arrays;
    std::vector<Eigen::MatrixXd>
        cells = {}; ///< each: a column a point, (degree+1)^dimension of them at equal distances,
                    ///< lexicographic; rows: x, y, z [mm], then the arrays' components

    /// Reference points of a cell in the order of the columns.
    static std::vector<Eigen::Vector3d> points(int dimension, int degree);
  };
} // namespace flank
