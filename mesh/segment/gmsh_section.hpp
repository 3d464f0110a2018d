// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/tooth_section.hpp"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace flank
{
  /// Hexahedra as Gmsh numbers them, nodes in [mm].
  struct GmshHexes
  {
    std::vector<Eigen::Vector3d> nodes;
    std::vector<std::array<int, 8>> hexes;
  };

  /// The section by its quadrilaterals (tooth) and transfinite columns (rim), extruded over the face width
  /// [mm], untwisted: hexahedra. Gmsh and the libraries it needs are in a module of their own, loaded when a
  /// body is first meshed.
  using MeshWithGmsh = GmshHexes(const ToothSection &section, const Gear &gear,
                                 const SectorResolution &resolution);
} // namespace flank
