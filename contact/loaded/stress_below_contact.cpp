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
      std::vector<half_space::LoadedRectangle> loads;
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
    FlankEnd end_near(const FlankEnds &ends, const double z, const double width)
    {
      constexpr double reach = 3; // of the contact's width
      const FlankEnd nearer = z < 0 ? FlankEnd::low : FlankEnd::high;
      return ends.distance(nearer, z) < reach * width ? nearer : FlankEnd::none;
    }

    /// The half-space's stress together with what the free end of a flank adds. Loads count as two points
    /// each along the generator for that. All but `z`, of the most pressed cell, is kept by reference. [mm]
    half_space::StressBelow with_end(const std::vector<half_space::LoadedRectangle> &loads,
                                     const FlankEnds &ends, const FlankEnd end, const double z,
                                     const double cos_base_helix)
    {
      const auto half_space = half_space::stress_below(loads, ends.poissons_ratio());
      return [&, half_space, end, z, cos_base_helix](const Eigen::Vector2d &at, const double depth) {
        Eigen::Matrix3d sum = half_space(at, depth);
        for (const half_space::LoadedRectangle &load : loads)
          for (const int side : { -1, 1 })
            {
              const double y = load.area.y + side * load.area.b / std::sqrt(3.0);
              sum +=
                  load.force / 2 *
                  ends.added_stress(end, z + y * cos_base_helix, { at.x() - load.area.x, at.y() - y, depth });
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
    const auto below = [&](const Gear &gear, Patch ContactCell::*side, const FlankEnds *of_body) {
      const LoadsOnBody on = loads_on(gear, side, *most, cells, force);
      const double z = (most->*side).z;
      const FlankEnd end = of_body ? end_near(*of_body, z, on.width) : FlankEnd::none;
      return end == FlankEnd::none
                 ? half_space::greatest_below(on.loads, on.points, on.width, gear.poissons_ratio)
                 : half_space::greatest_below(
                       with_end(on.loads, *of_body, end, z, std::cos(gear.base_helix_angle)), on.points,
                       on.width);
    };
    return half_space::greater_of(below(pair.pinion, &ContactCell::pinion, ends ? &ends->pinion : nullptr),
                                  below(pair.gear, &ContactCell::gear, ends ? &ends->gear : nullptr));
  }
} // namespace flank
