// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"
#include "mesh/segment/hex_mesh.hpp"

namespace flank
{
  /// Quadrilaterals of a transverse section at mid-face as plain data, with their exact geometry.
  struct SectionMesh
  {
    std::vector<Eigen::Vector2d> vertices; ///< [mm]
    std::vector<std::array<int, 4>> quads; ///< vertex indices at (0,0), (1,0), (0,1), (1,1)

    /// Exact position [mm] of a reference point in [0,1]^2 of a quadrilateral.
    std::function<Eigen::Vector2d(int quad, double first, double second)> map;
  };

  /// The section along a gear's face width, turned with its helix, in equal layers: cell layer * quads +
  /// quad, its third reference axis along +z, z = 0 at mid-face.
  HexMesh extruded(const SectionMesh &section, const Gear &gear, int layers);
} // namespace flank
