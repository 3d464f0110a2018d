// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/tooth_sector.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <map>
#include <memory>

namespace flank
{
  namespace
  {
    struct GmshSession
    {
      GmshSession()
      {
        gmsh::initialize(0, nullptr, false);
        gmsh::option::setNumber("General.Terminal", 0);
        gmsh::model::add("tooth sector");
      }
      ~GmshSession() { gmsh::finalize(); }
    };

    struct GmshHexes
    {
      std::vector<Eigen::Vector3d>    nodes;
      std::vector<std::array<int, 8>> hexes;
    };

    /// The section as transfinite strips (tooth rows) and columns (rim), extruded over the face width: hexahedra.
    GmshHexes mesh_with_gmsh(const ToothSection &section, const Gear &gear, const SectorResolution &resolution)
    {
      const GmshSession session;
      namespace geo       = gmsh::model::geo;
      const double bottom = -gear.face_width / 2;

      std::map<int, int> points;
      const auto         point = [&](const int vertex) {
        auto [it, is_new] = points.try_emplace(vertex, 0);
        if (is_new)
          it->second = geo::addPoint(section.vertices()[vertex].x(), section.vertices()[vertex].y(), bottom);
        return it->second;
      };
      const int                          centre = geo::addPoint(0, 0, bottom);
      std::map<std::pair<int, int>, int> lines;
      const auto                         line = [&](const int a, const int b, const bool arc, const int divisions, const double growth) {
        if (const auto it = lines.find({ a, b }); it != lines.end())
          return it->second;
        if (const auto it = lines.find({ b, a }); it != lines.end())
          return -it->second;
        const int tag = arc ? geo::addCircleArc(point(a), centre, point(b)) : geo::addLine(point(a), point(b));
        geo::mesh::setTransfiniteCurve(tag, divisions + 1, "Progression", growth);
        return lines[{ a, b }] = tag;
      };

      gmsh::vectorpair surfaces;
      const auto       surface = [&](const std::vector<int> &boundary, const std::vector<int> &corners) {
        const int tag = geo::addPlaneSurface({ geo::addCurveLoop(boundary) });
        geo::mesh::setTransfiniteSurface(tag, "Left", corners);
        geo::mesh::setRecombine(2, tag);
        surfaces.emplace_back(2, tag);
      };

      const int columns = section.tooth_columns(), rows = section.tooth_rows();
      for (int row = 0; row < rows; ++row)
        {
          const int a = section.tooth_vertex(row, 0), b = section.tooth_vertex(row + 1, 0), c = section.tooth_vertex(row + 1, columns),
                    d               = section.tooth_vertex(row, columns);
          std::vector<int> boundary = { line(a, b, false, 1, 1) };
          if (row + 1 < rows)
            boundary.push_back(line(b, c, true, columns, 1));
          else // single edges, because each is also the top of a rim column
            for (int k = 0; k < columns; ++k)
              boundary.push_back(line(section.tooth_vertex(rows, k), section.tooth_vertex(rows, k + 1), false, 1, 1));
          boundary.push_back(line(c, d, false, 1, 1));
          boundary.push_back(line(d, a, true, columns, 1));
          surface(boundary, { point(a), point(b), point(c), point(d) });
        }
      const int layers = section.rim_layers();
      for (int k = 0; k < section.rim_columns(); ++k)
        {
          const int a = section.rim_vertex(k, 0), b = section.rim_vertex(k, layers), c = section.rim_vertex(k + 1, layers),
                    d = section.rim_vertex(k + 1, 0);
          surface({ line(a, b, false, layers, section.rim_growth()), line(b, c, true, 1, 1),
                    -line(d, c, false, layers, section.rim_growth()), line(d, a, false, 1, 1) },
                  { point(a), point(b), point(c), point(d) });
        }
      gmsh::vectorpair extruded;
      geo::extrude(surfaces, 0, 0, gear.face_width, extruded, { resolution.face_layers }, {}, true);
      geo::synchronize();
      gmsh::model::mesh::generate(3);

      GmshHexes                result;
      std::vector<std::size_t> node_tags, element_tags, element_nodes;
      std::vector<double>      coordinates, parametric;
      gmsh::model::mesh::getNodes(node_tags, coordinates, parametric, -1, -1, true, false);
      std::map<std::size_t, int> index;
      for (std::size_t i = 0; i < node_tags.size(); ++i)
        if (index.try_emplace(node_tags[i], static_cast<int>(result.nodes.size())).second)
          result.nodes.emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
      gmsh::model::mesh::getElementsByType(5, element_tags, element_nodes);
      for (std::size_t e = 0; e < element_tags.size(); ++e)
        {
          std::array<int, 8> hex;
          for (int i = 0; i < 8; ++i)
            hex[i] = index.at(element_nodes[8 * e + i]);
          result.hexes.push_back(hex);
        }
      return result;
    }
  } // namespace

  std::string gmsh_version()
  {
    return GMSH_API_VERSION;
  }

  ToothSector make_tooth_sector(const Gear &gear, const SectorResolution &resolution)
  {
    ToothSector     sector{ gear, resolution, ToothSection(gear, resolution), {} };
    const auto     &section = sector.section;
    const int       n_quads = static_cast<int>(section.quads().size()), n_layers = resolution.face_layers;
    const int       n_vertex  = static_cast<int>(section.vertices().size());
    const GmshHexes gmsh_mesh = mesh_with_gmsh(section, gear, resolution);

    // Recognise every Gmsh node as (section vertex, plane).
    const double                     height = sector.layer_height();
    std::vector<std::pair<int, int>> place(gmsh_mesh.nodes.size());
    for (std::size_t i = 0; i < gmsh_mesh.nodes.size(); ++i)
      {
        const Eigen::Vector3d &x     = gmsh_mesh.nodes[i];
        const int              plane = static_cast<int>(std::lround((x.z() + gear.face_width / 2) / height));
        int                    best  = 0;
        double                 least = 1e300;
        for (int v = 0; v < n_vertex; ++v)
          if (const double d = (section.vertices()[v] - x.head<2>()).squaredNorm(); d < least)
            {
              least = d;
              best  = v;
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
        int                lowest = n_layers, n_low = 0;
        for (const int node : hex)
          lowest = std::min(lowest, place[node].second);
        for (const int node : hex)
          if (place[node].second == lowest && n_low < 4)
            key[n_low++] = place[node].first;
        std::sort(key.begin(), key.end());
        const auto it = quad_of.find(key);
        if (lowest < 0 || lowest >= n_layers || n_low != 4 || it == quad_of.end() || found[lowest * n_quads + it->second]++)
          throw ComputationError("Gmsh returned a hexahedron that is not one of the tooth sector's");
      }
    if (std::count(found.begin(), found.end(), 1) != static_cast<std::ptrdiff_t>(found.size()))
      throw ComputationError(fmt::format("Gmsh returned {} of the {} hexahedra of the tooth sector", gmsh_mesh.hexes.size(), found.size()));

    const InvoluteHelicoid helicoid = gear.flank();
    const auto             turned   = [twist = helicoid.twist()](const Eigen::Vector2d &p, const double z) {
      const double c = std::cos(twist * z), s = std::sin(twist * z);
      return Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), z);
    };
    const double bottom = -gear.face_width / 2;
    for (int plane = 0; plane <= n_layers; ++plane)
      for (const Eigen::Vector2d &v : section.vertices())
        sector.mesh.vertices.push_back(turned(v, bottom + plane * height));
    for (int layer = 0; layer < n_layers; ++layer)
      for (const auto &quad : section.quads())
        {
          std::array<int, 8> cell;
          for (int i = 0; i < 4; ++i)
            {
              cell[i]     = layer * n_vertex + quad.vertices[i];
              cell[i + 4] = (layer + 1) * n_vertex + quad.vertices[i];
            }
          sector.mesh.cells.push_back(cell);
        }
    sector.mesh.map = [copy = std::make_shared<ToothSection>(section), n_quads, bottom, height, turned](const int              cell,
                                                                                                        const Eigen::Vector3d &x) {
      return turned(copy->map(cell % n_quads, x[0], x[1]), bottom + (cell / n_quads + x[2]) * height);
    };
    return sector;
  }

  HexMesh joined_sectors(const ToothSector &sector, const int teeth)
  {
    const auto &section    = sector.section;
    const int   n_vertex   = static_cast<int>(section.vertices().size());
    const int   per_sector = static_cast<int>(sector.mesh.vertices.size()), n_cells = static_cast<int>(sector.mesh.cells.size());
    const bool  closed = teeth == sector.gear.teeth;
    FLANK_ASSERT(teeth >= 1 && teeth <= sector.gear.teeth, std::to_string(teeth));

    // The cut at +pitch/2 (column 0) of tooth t is the cut at -pitch/2 (last column) of tooth t+1.
    std::vector<int> twin(n_vertex, -1);
    for (int l = 0; l <= section.rim_layers(); ++l)
      twin[section.rim_vertex(section.rim_columns(), l)] = section.rim_vertex(0, l);
    const auto shared = [&](const int tooth, const int vertex) { return twin[vertex % n_vertex] >= 0 && (closed || tooth > 0); };

    HexMesh          whole;
    std::vector<int> global(static_cast<std::size_t>(per_sector) * teeth, -1);
    for (int t = 0; t < teeth; ++t)
      for (int v = 0; v < per_sector; ++v)
        if (!shared(t, v))
          {
            global[t * per_sector + v] = static_cast<int>(whole.vertices.size());
            whole.vertices.push_back(Eigen::AngleAxisd(t * sector.gear.pitch_angle(), Eigen::Vector3d::UnitZ()) * sector.mesh.vertices[v]);
          }
    for (int t = 0; t < teeth; ++t)
      for (int v = 0; v < per_sector; ++v)
        if (shared(t, v))
          global[t * per_sector + v] = global[(t + teeth - 1) % teeth * per_sector + v / n_vertex * n_vertex + twin[v % n_vertex]];
    for (int t = 0; t < teeth; ++t)
      for (const auto &cell : sector.mesh.cells)
        {
          std::array<int, 8> copy;
          for (int i = 0; i < 8; ++i)
            copy[i] = global[t * per_sector + cell[i]];
          whole.cells.push_back(copy);
        }
    whole.map = [map = sector.mesh.map, n_cells, pitch = sector.gear.pitch_angle()](const int              cell,
                                                                                    const Eigen::Vector3d &x) -> Eigen::Vector3d {
      return Eigen::AngleAxisd(cell / n_cells * pitch, Eigen::Vector3d::UnitZ()) * map(cell % n_cells, x);
    };
    return whole;
  }
} // namespace flank
