// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/extrusion.hpp"

#include <cmath>

namespace flank
{
  HexMesh extruded(const SectionMesh &section, const Gear &gear, const int layers)
  {
    const int n_vertices = static_cast<int>(section.vertices.size()),
              n_quads = static_cast<int>(section.quads.size());
    const double bottom = -gear.face_width / 2, height = gear.face_width / layers;
    const auto turned = [twist = gear.flank().twist()](const Eigen::Vector2d &p, const double z) {
      const double c = std::cos(twist * z), s = std::sin(twist * z);
      return Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), z);
    };
    HexMesh mesh;
    for (int plane = 0; plane <= layers; ++plane)
      for (const Eigen::Vector2d &v : section.vertices)
        mesh.vertices.push_back(turned(v, bottom + plane * height));
    for (int layer = 0; layer < layers; ++layer)
      for (const std::array<int, 4> &quad : section.quads)
        {
          std::array<int, 8> cell;
          for (int i = 0; i < 4; ++i)
            {
              cell[i] = layer * n_vertices + quad[i];
              cell[i + 4] = (layer + 1) * n_vertices + quad[i];
            }
          mesh.cells.push_back(cell);
        }
    mesh.map = [map = section.map, n_quads, bottom, height, turned](const int cell,
                                                                    const Eigen::Vector3d &x) {
      return turned(map(cell % n_quads, x[0], x[1]), bottom + (cell / n_quads + x[2]) * height);
    };
    return mesh;
  }
} // namespace flank
