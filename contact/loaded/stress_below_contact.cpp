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
            if (cells[i].slice == most.slice)
              {
                result.points.push_back(at);
                result.width += 2 * patch.half_profile;
              }
          }
      return result;
    }

    /// The free end near a place; none where it is farther than the contact reaches.
    FlankEnd end_near(const FlankEdges &ends, const double z, const double width)
    {
      constexpr double reach = 3; // of the contact's width
      const FlankEnd nearer = z < 0 ? FlankEnd::low : FlankEnd::high;
      return ends.distance(edge_at(nearer), { 0, z }) < reach * width ? nearer : FlankEnd::none;
    }

    /// Where the greatest stresses are looked for near an end: in the slice, and in those within a width of
    /// the contact along the generator below the most pressed cell.
    std::vector<Eigen::Vector2d> with_neighbours(const LoadsOnBody &on)
    {
      std::vector<Eigen::Vector2d> points = on.points;
      for (const half_space::LoadedRectangle &load : on.loads)
        if (std::abs(load.area.x) <= load.area.a && load.area.y != 0 && std::abs(load.area.y) <= on.width)
          points.emplace_back(load.area.x, load.area.y);
      return points;
    }

    /// The half-space's stress together with what the free end of a flank adds. Loads count as two points
    /// each along the generator for that. No stress beyond the end, which an acute one cuts off the depth.
    /// All but `z`, of the most pressed cell, is kept by reference. [mm]
    half_space::StressBelow with_end(const std::vector<half_space::LoadedRectangle> &loads,
                                     const FlankEdges &ends, const Gear &gear, const FlankEnd end,
                                     const double z)
    {
      const auto half_space = half_space::stress_below(loads, ends.poissons_ratio());
      const double cos_base_helix = std::cos(gear.base_helix_angle), opening = opening_at(gear, end);
      return [&, half_space, edge = edge_at(end), z, cos_base_helix, opening](const Eigen::Vector2d &at,
                                                                              const double depth) {
        const double from_end = ends.distance(edge, { 0, z + at.y() * cos_base_helix });
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        if (depth * std::cos(opening) > from_end * std::sin(opening))
          return sum;
        sum = half_space(at, depth);
        for (const half_space::LoadedRectangle &load : loads)
          for (const int side : { -1, 1 })
            {
              const double y = load.area.y + side * load.area.b / std::sqrt(3.0);
              sum += load.force / 2 *
                     ends.added_stress(edge, { 0, z + y * cos_base_helix },
                                       { at.x() - load.area.x, at.y() - y, depth });
            }
        return sum;
      };
    }
  } // namespace

  half_space::SubsurfaceStress below_greatest_pressure(const GearPair &pair, const EndsOfPair *ends,
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
    const FlankEnd of_pinion =
                       ends ? end_near(ends->pinion, most->pinion.z, on_pinion.width) : FlankEnd::none,
                   of_gear = ends ? end_near(ends->gear, most->gear.z, on_gear.width) : FlankEnd::none;
    if (of_pinion == FlankEnd::none && of_gear == FlankEnd::none)
      return half_space::greatest_below_both(on_pinion.loads, on_pinion.points, on_pinion.width,
                                             pair.pinion.poissons_ratio, pair.gear.poissons_ratio);
    const auto below = [](const Gear &gear, const LoadsOnBody &on, const FlankEdges &of_body,
                          const FlankEnd end, const double z) {
      return end == FlankEnd::none
                 ? half_space::greatest_below(on.loads, on.points, on.width, gear.poissons_ratio)
                 : half_space::greatest_below(with_end(on.loads, of_body, gear, end, z), with_neighbours(on),
                                              on.width);
    };
    return half_space::greater_of(below(pair.pinion, on_pinion, ends->pinion, of_pinion, most->pinion.z),
                                  below(pair.gear, on_gear, ends->gear, of_gear, most->gear.z));
  }
} // namespace flank
