// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/edge_intensity.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Mean of the distance from the tip edge to a power, over a patch: by Gauss's theorem from its outline.
    /// [mm^power]
    double mean_power_of_distance(const Patch &patch, const Gear &gear, const double power)
    {
      const double q_tip = gear.usable_tip_roll * gear.usable_tip_roll;
      double integral = 0, area = 0;
      for (std::size_t i = 0; i < patch.outline.size(); ++i)
        {
          const Eigen::Vector2d &a = patch.outline[i], &b = patch.outline[(i + 1) % patch.outline.size()];
          const double from = std::max(0.0, 0.5 * gear.base_radius * (q_tip - a.x())),
                       to = std::max(0.0, 0.5 * gear.base_radius * (q_tip - b.x())), along = b.y() - a.y();
          const auto mean = [&](const double p) { // of the distance to the power p, along the side
            return std::abs(to - from) <= 1e-9 * (to + from)
                       ? std::pow(0.5 * (from + to), p)
                       : (std::pow(to, p + 1) - std::pow(from, p + 1)) / ((p + 1) * (to - from));
          };
          integral += along * mean(power + 1) / (power + 1);
          area += along * 0.5 * (from + to);
        }
      return integral / area;
    }

    /// Whether the edge bounds a patch: its corners there are those of a clipped polygon.
    bool reaches_tip(const Patch &patch, const Gear &gear)
    {
      const auto [low, high] =
          std::ranges::minmax(patch.outline, {}, [](const Eigen::Vector2d &corner) { return corner.x(); });
      const double q_tip = gear.usable_tip_roll * gear.usable_tip_roll;
      return q_tip - high.x() < 1e-3 * (q_tip - low.x());
    }
  } // namespace

  EdgeIntensity intensity_at_ends(const PositionGrid &grid, const Eigen::VectorXd &pressure)
  {
    double greatest = 0;
    EdgeIntensity result;
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      if (const ContactCell &cell = grid.cells()[i]; cell.place == CellPlace::face_end &&
                                                     grid.slices()[cell.slice].face_end &&
                                                     pressure[static_cast<Eigen::Index>(i)] > greatest)
        {
          greatest = pressure[static_cast<Eigen::Index>(i)];
          result.power = grid.slices()[static_cast<std::size_t>(cell.slice)].end_power;
          result.intensity = // of the mean over a cell at the end
              greatest * (1 + result.power) / std::pow(2 * cell.pinion.half_generator, result.power);
        }
    return result;
  }

  std::vector<EdgeIntensity> intensities_at_tips(const GearPair &pair, const PositionGrid &grid,
                                                 const Eigen::VectorXd &force)
  {
    const std::array<double, 2> &powers = grid.position().tip_powers();
    struct Sum
    {
      double force = 0, of_power = 0;
    };
    std::vector<std::array<Sum, 2>> sums(grid.slices().size());
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      for (const std::size_t tip : { 0, 1 })
        {
          const ContactCell &cell = grid.cells()[i];
          const Gear &gear = tip == 0 ? pair.pinion : pair.gear;
          const Patch &patch = tip == 0 ? cell.pinion : cell.gear;
          if (powers[tip] < 0 && reaches_tip(patch, gear))
            {
              Sum &sum = sums[cell.slice][tip];
              sum.force += force[static_cast<Eigen::Index>(i)];
              sum.of_power += cell.area * mean_power_of_distance(patch, gear, powers[tip]);
            }
        }
    std::vector<EdgeIntensity> result;
    for (const std::array<Sum, 2> &of_slice : sums)
      {
        const std::size_t tip = of_slice[0].force >= of_slice[1].force ? 0 : 1;
        const Sum &sum = of_slice[tip];
        result.push_back(sum.force > 0 ? EdgeIntensity{ sum.force / sum.of_power, powers[tip] }
                                       : EdgeIntensity{});
      }
    return result;
  }
} // namespace flank
