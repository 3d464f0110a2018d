// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/gmsh_section.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <map>
#include <mutex>

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
    ~GmshSession()
    {
      try
        {
          gmsh::finalize();
        }
      catch (const std::string &) // after a failure; nothing of it is used any more
        {
        }
    }
  };

  /// Nodes and hexahedra of the model.
  flank::GmshHexes meshed()
  {
    flank::GmshHexes result;
    std::vector<std::size_t> node_tags, element_tags, element_nodes;
    std::vector<double> coordinates, parametric;
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

  /// One model from its points up to its mesh; what it has made so far is known to it alone.
  flank::GmshHexes mesh_of(const flank::ToothSection &section, const flank::Gear &gear,
                           const flank::SectorResolution &resolution)
  {
    const GmshSession session;
    namespace geo = gmsh::model::geo;
    const double bottom = -gear.face_width / 2;

    std::map<int, int> points;
    const auto point = [&](const int vertex) {
      auto [it, is_new] = points.try_emplace(vertex, 0);
      if (is_new)
        it->second = geo::addPoint(section.vertices()[vertex].x(), section.vertices()[vertex].y(), bottom);
      return it->second;
    };
    const int centre = geo::addPoint(0, 0, bottom);
    std::map<std::pair<int, int>, int> lines;
    const auto line = [&](const int a, const int b, const bool arc, const int divisions,
                          const double growth) {
      if (const auto it = lines.find({ a, b }); it != lines.end())
        return it->second;
      if (const auto it = lines.find({ b, a }); it != lines.end())
        return -it->second;
      const int tag = arc ? geo::addCircleArc(point(a), centre, point(b)) : geo::addLine(point(a), point(b));
      geo::mesh::setTransfiniteCurve(tag, divisions + 1, "Progression", growth);
      return lines[{ a, b }] = tag;
    };

    gmsh::vectorpair surfaces;
    const auto surface = [&](const std::vector<int> &boundary, const std::vector<int> &corners) {
      const int tag = geo::addPlaneSurface({ geo::addCurveLoop(boundary) });
      geo::mesh::setTransfiniteSurface(tag, "Left", corners);
      geo::mesh::setRecombine(2, tag);
      surfaces.emplace_back(2, tag);
    };

    const int columns = section.tooth_columns(), rows = section.tooth_rows();
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < columns; ++k)
        {
          const int a = section.tooth_vertex(row, k), b = section.tooth_vertex(row + 1, k),
                    c = section.tooth_vertex(row + 1, k + 1), d = section.tooth_vertex(row, k + 1);
          surface({ line(a, b, false, 1, 1), line(b, c, row + 1 < rows, 1, 1), -line(d, c, false, 1, 1),
                    line(d, a, !section.is_chamfer(row, k), 1, 1) },
                  { point(a), point(b), point(c), point(d) });
        }
    int from = 0;
    for (const auto &[layers, growth] : section.rim_blocks())
      {
        const int to = from + layers;
        for (int k = 0; k < section.rim_columns(); ++k)
          {
            const int a = section.rim_vertex(k, from), b = section.rim_vertex(k, to),
                      c = section.rim_vertex(k + 1, to), d = section.rim_vertex(k + 1, from);
            surface({ line(a, b, false, layers, growth), line(b, c, to == section.rim_layers(), 1, 1),
                      -line(d, c, false, layers, growth), line(d, a, false, 1, 1) },
                    { point(a), point(b), point(c), point(d) });
          }
        from = to;
      }
    gmsh::vectorpair extruded;
    geo::extrude(surfaces, 0, 0, gear.face_width, extruded, { resolution.face_layers }, {}, true);
    geo::synchronize();
    gmsh::model::mesh::generate(3);

    return meshed();
  }
} // namespace

extern "C" __attribute__((visibility("default"))) flank::GmshHexes flank_mesh_with_gmsh(
    const flank::ToothSection &section, const flank::Gear &gear, const flank::SectorResolution &resolution)
try
  {
    // Gmsh has one model for the whole process: threads that need the sectors of two bodies take turns.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    return mesh_of(section, gear, resolution);
  }
catch (const std::string &reason) // which is what Gmsh throws
  {
    throw flank::ComputationError(fmt::format(
        "Gmsh cannot mesh a tooth of the {}: {}; its bore, root or fillet is out of proportion (flank check)",
        gear.name, reason));
  }
