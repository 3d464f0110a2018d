// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/flank_surface.hpp"

#include <vector>

namespace flank
{
  /// Rings of elements about the loaded ones along the flank, and layers below it: one ring leaves up to
  /// 0.35 %, three rings change less than 0.04 %.
  constexpr int block_rings = 2, block_depth = 3;

  /// Layers of elements below the flank that a block reaches through, of a tooth of so many columns.
  constexpr int block_depth_of(const int tooth_columns)
  {
    return tooth_columns < block_depth ? tooth_columns : block_depth;
  }

  /// A block of real elements around loaded flank elements, block_rings and block_depth large, cut off from
  /// the rest. Displacements of its flank nodes along their inward normals for three kinds of data; unit
  /// forces, mm.
  struct FlankBlock
  {
    int first_row, last_row, first_layer, last_layer; ///< elements, inclusive
    int rows_of_nodes, layers_of_nodes;
    int node(const int row_node, const int layer_node) const
    {
      return layer_node * rows_of_nodes + row_node;
    } ///< local flank node

    Eigen::MatrixXd load_response;  ///< for unit normal forces on the block's flank nodes, cut held [mm/N]
    Eigen::Matrix3Xd cut_positions; ///< nodes of the internal cut [mm]
    Eigen::MatrixXd cut_response;   ///< for unit displacements of the cut nodes (3 columns a node)

    /// True free faces other than the loaded flank: tip land and chamfer, face ends, the opposite flank if
    /// the block reaches it.
    struct Face
    {
      std::vector<int> nodes;                 ///< into the columns (three each) of face_response
      std::vector<Eigen::Vector3d> positions; ///< lexicographic in the face's two axes
      double outward;                         ///< sign of d1 x d2 for the outward normal
      int end;                                ///< the sign of z where it is an end of the tooth, else 0
    };
    std::vector<Face> faces;
    Eigen::MatrixXd face_response; ///< for unit forces on the free faces' nodes [mm/N]
  };

  /// Makes the blocks of one body. By the screw symmetry of the mesh a block away from the face ends serves
  /// every layer.
  class FlankBlocks
  {
  public:
    /// Keeps references to the sector and the body.
    FlankBlocks(const ToothSector &sector, const ElasticBody &body);

    /// The block around the loaded elements (inclusive ranges of rows and layers).
    FlankBlock around(int first_row, int last_row, int first_layer, int last_layer) const;

  private:
    class Builder;

    const ToothSector &sector_;
    const ElasticBody &body_;
    Eigen::Matrix3Xd normals_;
    FlankSurface surface_;
    std::vector<Eigen::MatrixXd> stiffness_; ///< of the tooth cells the blocks can use
    int depth_;
  };

  /// Layers to move loaded elements by to find them in the one block that stands for all that touch no face
  /// end; 0 for the others.
  int layer_shift(const FlankSurface &surface, int first_layer, int last_layer);
} // namespace flank
