// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/stress_below_contact.hpp"

#include <cmath>

namespace flank
{
  namespace
  {
    /// The loads on one body, and the places below which its stresses are looked for, as seen from the most
    /// pressed cell.
    struct LoadsOnBody
    {
      std::vector<half_space::LoadedRectangle> loads; ///< the most pressed cell's is at the origin
      std::vector<const Patch *> patches;             ///< of the loads
      std::vector<Eigen::Vector2d> points;
      double width = 0; ///< of the loaded cells of the slice across the profile [mm]
    };

    LoadsOnBody loads_on(const Gear &gear, Patch ContactCell::*side, const ContactCell &most,
                         const std::vector<ContactCell> &cells, const Eigen::VectorXd &force)
    {
      const InvoluteHelicoid flank = gear.flank();
      LoadsOnBody result;
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (const double f = force[static_cast<Eigen::Index>(i)];
            f > 0 && cells[i].pinion.tooth == most.pinion.tooth)
          {
            const Patch &patch = cells[i].*side;
            const Eigen::Vector2d at = patch.seen_from(most.*side, flank);
            result.loads.push_back({ { at.x(), at.y(), patch.half_profile, patch.half_generator }, f });
            result.patches.push_back(&patch);
            if (cells[i].slice == most.slice)
              {
                result.points.push_back(at);
                result.width += 2 * patch.half_profile;
              }
          }
      return result;
    }

    /// The free edges near a place: of the ends the nearer one; none that is farther than the contact
    /// reaches.
    FreeEdges edges_near(const FlankEdges &edges, const FlankEdges::Place &place, const double width)
    {
      constexpr double reach = 3; // of the contact's width
      const auto is_near = [&](const FlankEdge edge) { return edges.distance(edge, place) < reach * width; };
      const FlankEnd nearer = place.z < 0 ? FlankEnd::low : FlankEnd::high;
      return { .end = is_near(edge_at(nearer)) ? nearer : FlankEnd::none,
               .tip = edges.has_tip() && is_near(FlankEdge::tip) };
    }

    /// Where the greatest stresses are looked for near an edge: in the slice, and in those within a width of
    /// the contact along the generator below the most pressed cell.
    std::vector<Eigen::Vector2d> with_neighbours(const LoadsOnBody &on)
    {
      std::vector<Eigen::Vector2d> points = on.points;
      for (const half_space::LoadedRectangle &load : on.loads)
        if (std::abs(load.area.x) <= load.area.a && load.area.y != 0 && std::abs(load.area.y) <= on.width)
          points.emplace_back(load.area.x, load.area.y);
      return points;
    }

    /// Whether a place lies beyond a free edge's other face, which an acute one cuts off the depth.
    bool is_beyond(const double opening, const double from_edge, const double depth)
    {
      return depth * std::cos(opening) > from_edge * std::sin(opening);
    }

    struct PointForce
    {
      Eigen::Vector2d at; ///< as the loads
      FlankEdges::Place place;
      double force;
    };

    std::vector<PointForce> point_forces(const LoadsOnBody &on, const FlankEdges &edges,
                                         const FreeEdges &free)
    {
      std::vector<PointForce> forces;
      for (std::size_t k = 0; k < on.loads.size(); ++k)
        {
          const half_space::LoadedRectangle &load = on.loads[k];
          const std::vector<FlankEdges::PartOfPatch> parts = edges.parts_of(free, *on.patches[k]);
          for (const auto &[from_middle, place] : parts)
            forces.push_back({ Eigen::Vector2d(load.area.x, load.area.y) + from_middle, place,
                               load.force / static_cast<double>(parts.size()) });
        }
      return forces;
    }

    /// The half-space's stress together with what the free edges of a flank add to point_forces(). No stress
    /// beyond the edges. The loads and the edges are kept by reference; `most`: place of the most pressed
    /// cell. [mm]
    half_space::StressBelow with_edges(const LoadsOnBody &on, const FlankEdges &edges, const FreeEdges &free,
                                       const FlankEdges::Place &most)
    {
      return [half_space = half_space::stress_below(on.loads, edges.poissons_ratio()),
              forces = point_forces(on, edges, free), &edges, free,
              most](const Eigen::Vector2d &at, const double depth) {
        bool is_inside = true;
        Eigen::Matrix3d sum = half_space(at, depth);
        free.each([&](const FlankEdge edge) {
          is_inside = is_inside && !is_beyond(edges.opening(edge), edges.distance(edge, most, at), depth);
          if (is_inside)
            for (const PointForce &point : forces)
              sum +=
                  point.force * edges.added_stress(edge, point.place,
                                                   { at.x() - point.at.x(), at.y() - point.at.y(), depth });
        });
        return is_inside ? sum : Eigen::Matrix3d::Zero();
      };
    }
  } // namespace

  half_space::SubsurfaceStress below_greatest_pressure(const GearPair &pair, const EdgesOfPair *edges,
                                                       const std::vector<ContactCell> &cells,
                                                       const Eigen::VectorXd &force,
                                                       const Eigen::VectorXd &pressure)
  {
    const ContactCell *most = nullptr;
    double peak = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (const double of_cell = pressure[static_cast<Eigen::Index>(i)];
          !is_sharp(cells[i].place) && of_cell > peak)
        peak = of_cell, most = &cells[i];
    if (!most)
      return {};
    const LoadsOnBody on_pinion = loads_on(pair.pinion, &ContactCell::pinion, *most, cells, force),
                      on_gear = loads_on(pair.gear, &ContactCell::gear, *most, cells, force);
    const auto place = [](const Patch &patch) { return FlankEdges::Place{ patch.roll, patch.z }; };
    const FreeEdges of_pinion =
                        edges ? edges_near(edges->pinion, place(most->pinion), on_pinion.width) : FreeEdges{},
                    of_gear = edges ? edges_near(edges->gear, place(most->gear), on_gear.width) : FreeEdges{};
    if (of_pinion == FreeEdges{} && of_gear == FreeEdges{})
      return half_space::greatest_below_both(on_pinion.loads, on_pinion.points, on_pinion.width,
                                             pair.pinion.poissons_ratio, pair.gear.poissons_ratio);
    const auto below = [&](const Gear &gear, const LoadsOnBody &on, const FlankEdges &of_body,
                           const FreeEdges &free, const Patch &at) {
      return free == FreeEdges{}
                 ? half_space::greatest_below(on.loads, on.points, on.width, gear.poissons_ratio)
                 : half_space::greatest_below(with_edges(on, of_body, free, place(at)), with_neighbours(on),
                                              on.width);
    };
    return half_space::greater_of(below(pair.pinion, on_pinion, edges->pinion, of_pinion, most->pinion),
                                  below(pair.gear, on_gear, edges->gear, of_gear, most->gear));
  }
} // namespace flank
