// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/tooth_sector.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/module.hpp"
#include "mesh/segment/extrusion.hpp"
#include "mesh/segment/gmsh_section.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <map>
#include <memory>

namespace flank
{
  std::string gmsh_version()
  {
    return GMSH_API_VERSION;
  }

  namespace
  {
    /// Every hexahedron of the sector must be one of Gmsh's, whose nodes are recognised as (vertex of the
    /// section, plane). Throws ComputationError.
    void require_same_hexahedra(const GmshHexes &gmsh_mesh, const ToothSector &sector)
    {
      const Gear &gear = sector.gear;
      const ToothSection &section = sector.section;
      const int n_quads = static_cast<int>(section.quads().size()), n_layers = sector.resolution.face_layers,
                n_vertex = static_cast<int>(section.vertices().size());
      const double height = sector.layer_height();
      std::vector<std::pair<int, int>> place(gmsh_mesh.nodes.size());
      for (std::size_t i = 0; i < gmsh_mesh.nodes.size(); ++i)
        {
          const Eigen::Vector3d &x = gmsh_mesh.nodes[i];
          const int plane = static_cast<int>(std::lround((x.z() + gear.face_width / 2) / height));
          int best = 0;
          double least = 1e300;
          for (int v = 0; v < n_vertex; ++v)
            if (const double d = (section.vertices()[v] - x.head<2>()).squaredNorm(); d < least)
              {
                least = d;
                best = v;
              }
          place[i] = { best, std::sqrt(least) < 1e-6 * gear.tip_radius ? plane : -1 };
        }
      std::map<std::array<int, 4>, int> quad_of;
      for (int q = 0; q < n_quads; ++q)
        {
          auto key = section.quads()[q].vertices;
          std::sort(key.begin(), key.end());
          quad_of[key] = q;
        }

      std::vector<char> found(static_cast<std::size_t>(n_quads) * n_layers, 0);
      for (const auto &hex : gmsh_mesh.hexes)
        {
          std::array<int, 4> key{};
          int lowest = n_layers, n_low = 0;
          for (const int node : hex)
            lowest = std::min(lowest, place[node].second);
          for (const int node : hex)
            if (place[node].second == lowest && n_low < 4)
              key[n_low++] = place[node].first;
          std::sort(key.begin(), key.end());
          const auto it = quad_of.find(key);
          if (lowest < 0 || lowest >= n_layers || n_low != 4 || it == quad_of.end() ||
              found[lowest * n_quads + it->second]++)
            throw ComputationError("Gmsh returned a hexahedron that is not one of the tooth sector's");
        }
      if (std::count(found.begin(), found.end(), 1) != static_cast<std::ptrdiff_t>(found.size()))
        throw ComputationError(fmt::format("Gmsh returned {} of the {} hexahedra of the tooth sector",
                                           gmsh_mesh.hexes.size(), found.size()));
    }
  } // namespace

  ToothSector make_tooth_sector(const Gear &gear, const SectorResolution &resolution)
  {
    ToothSector sector{
      .gear = gear, .resolution = resolution, .section = ToothSection(gear, resolution), .mesh = {}
    };
    const auto &section = sector.section;
    const GmshHexes gmsh_mesh =
        module_function<MeshWithGmsh>("libflank_gmsh.so", "flank_mesh_with_gmsh")(section, gear, resolution);

    require_same_hexahedra(gmsh_mesh, sector);

    SectionMesh plane{ section.vertices(),
                       {},
                       [copy = std::make_shared<ToothSection>(section)](const int quad, const double down,
                                                                        const double across) {
                         return copy->map(quad, down, across);
                       } };
    for (const ToothSection::Quad &quad : section.quads())
      plane.quads.push_back(quad.vertices);
    sector.mesh = extruded(plane, gear, resolution.face_layers);
    return sector;
  }

  HexMesh joined_sectors(const ToothSector &sector, const int teeth)
  {
    const auto &section = sector.section;
    const int n_vertex = static_cast<int>(section.vertices().size());
    const int per_sector = static_cast<int>(sector.mesh.vertices.size()),
              n_cells = static_cast<int>(sector.mesh.cells.size());
    const bool closed = teeth == sector.gear.teeth;
    FLANK_ASSERT(teeth >= 1 && teeth <= sector.gear.teeth, std::to_string(teeth));

    // The cut at +pitch/2 (column 0) of tooth t is the cut at -pitch/2 (last column) of tooth t+1.
    std::vector<int> twin(n_vertex, -1);
    for (int l = 0; l <= section.rim_layers(); ++l)
      twin[section.rim_vertex(section.rim_columns(), l)] = section.rim_vertex(0, l);
    const auto shared = [&](const int tooth, const int vertex) {
      return twin[vertex % n_vertex] >= 0 && (closed || tooth > 0);
    };

    HexMesh whole;
    std::vector<int> global(static_cast<std::size_t>(per_sector) * teeth, -1);
    for (int t = 0; t < teeth; ++t)
      for (int v = 0; v < per_sector; ++v)
        if (!shared(t, v))
          {
            global[t * per_sector + v] = static_cast<int>(whole.vertices.size());
            whole.vertices.push_back(
                Eigen::AngleAxisd(t * sector.gear.pitch_angle(), Eigen::Vector3d::UnitZ()) *
                sector.mesh.vertices[v]);
          }
    for (int t = 0; t < teeth; ++t)
      for (int v = 0; v < per_sector; ++v)
        if (shared(t, v))
          global[t * per_sector + v] =
              global[(t + teeth - 1) % teeth * per_sector + v / n_vertex * n_vertex + twin[v % n_vertex]];
    for (int t = 0; t < teeth; ++t)
      for (const auto &cell : sector.mesh.cells)
        {
          std::array<int, 8> copy;
          for (int i = 0; i < 8; ++i)
            copy[i] = global[t * per_sector + cell[i]];
          whole.cells.push_back(copy);
        }
    whole.map = [map = sector.mesh.map, n_cells, pitch = sector.gear.pitch_angle()](
                    const int cell, const Eigen::Vector3d &x) -> Eigen::Vector3d {
      return Eigen::AngleAxisd(cell / n_cells * pitch, Eigen::Vector3d::UnitZ()) * map(cell % n_cells, x);
    };
    return whole;
  }
} // namespace flank
