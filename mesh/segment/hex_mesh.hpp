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
} // namespace flank
