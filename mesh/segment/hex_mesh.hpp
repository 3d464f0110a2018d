// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <array>
#include <functional>
#include <vector>

namespace flank
{
  /// A hexahedral mesh as plain data, with its exact geometry.
  struct HexMesh
  {
    std::vector<Eigen::Vector3d> vertices; ///< [mm]
    std::vector<std::array<int, 8>>
        cells; ///< vertex indices, lexicographic: vertex i sits at reference corner (i&1, i>>1&1, i>>2)

    /// Exact position [mm] of a reference point in [0,1]^3 of a cell. Must interpolate the cell's vertices.
    std::function<Eigen::Vector3d(int cell, const Eigen::Vector3d &reference)> map;
  };

  /// Trilinear map through a mesh's own vertices (straight edges).
  inline Eigen::Vector3d trilinear(const HexMesh &mesh, const int cell, const Eigen::Vector3d &reference)
  {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int i = 0; i < 8; ++i)
      {
        double weight = 1;
        for (int d = 0; d < 3; ++d)
          weight *= (i >> d & 1) ? reference[d] : 1 - reference[d];
        point += weight * mesh.vertices[mesh.cells[cell][i]];
      }
    return point;
  }
} // namespace flank
