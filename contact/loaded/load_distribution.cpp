// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/load_distribution.hpp"

#include <algorithm>

namespace flank
{
  namespace
  {
    constexpr int roll_points = 61, face_points = 41;

    std::vector<double> spread(const double low, const double high, const int n)
    {
      std::vector<double> result(n);
      for (int i = 0; i < n; ++i)
        result[i] = low + (high - low) * i / (n - 1);
      return result;
    }

    int slice_index(const GearPair &pair, const double z, const int slices)
    {
      const double at = (z - pair.face_low) / pair.common_face_width * slices;
      return std::clamp(static_cast<int>(at), 0, slices - 1);
    }

    template <class Removed>
    FlankMap map_of(const RollAngles &roll, const double low, const double high, const Removed &removed)
    {
      FlankMap map{ .roll = spread(roll.start_of_active_profile, roll.tip, roll_points),
                    .z = spread(low, high, face_points),
                    .value = {} };
      map.value.resize(roll_points, face_points);
      for (int i = 0; i < roll_points; ++i)
        for (int j = 0; j < face_points; ++j)
          map.value(i, j) = removed(map.roll[i], map.z[j]);
      return map;
    }
  } // namespace

  double face_load_factor(const GearPair &pair, const std::vector<PositionResult> &cycle, const int slices)
  {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(slices);
    for (const PositionResult &position : cycle)
      for (const LineLoad &line : position.lines)
        load[slice_index(pair, line.z, slices)] += line.load_per_length * line.height;
    return load.sum() > 0 ? load.maxCoeff() / load.mean() : 0;
  }

  FlankMap contact_pattern(const GearPair &pair, const std::vector<PositionResult> &cycle, const int slices)
  {
    FlankMap map{ spread(pair.pinion_roll.start_of_active_profile, pair.pinion_roll.tip, roll_points),
                  {},
                  {} };
    for (int s = 0; s < slices; ++s)
      map.z.push_back(pair.face_low + (s + 0.5) / slices * pair.common_face_width);
    map.value = Eigen::MatrixXd::Zero(roll_points, slices);

    // The way of the contact along the profile at each face position: one entry a position and pair, in the
    // order of meshing.
    struct Entry
    {
      double progress, along, half_width, pressure;
    };
    const double rb = pair.pinion.base_radius;
    const auto along = [&](const double roll) { return profile_length(0, roll, rb); };
    std::vector<std::vector<Entry>> ways(slices);
    for (const PositionResult &position : cycle)
      for (const LineLoad &line : position.lines)
        {
          auto &way = ways[slice_index(pair, line.z, slices)];
          const Entry entry{ position.phase + line.pair, along(line.pinion_roll), line.half_width,
                             line.max_pressure };
          // Of the parts of a divided slice the one that presses most.
          if (way.empty() || way.back().progress != entry.progress)
            way.push_back(entry);
          else if (entry.pressure > way.back().pressure)
            way.back() = entry;
        }
    const double step = 1.01 / cycle.size();
    for (int s = 0; s < slices; ++s)
      {
        auto &way = ways[s];
        std::sort(way.begin(), way.end(),
                  [](const Entry &a, const Entry &b) { return a.progress < b.progress; });
        for (int i = 0; i < roll_points; ++i)
          {
            const double at = along(map.roll[i]);
            double &value = map.value(i, s);
            for (std::size_t e = 0; e < way.size(); ++e)
              {
                if (std::abs(at - way[e].along) <= way[e].half_width)
                  value = std::max(value, way[e].pressure);
                if (e + 1 < way.size() && way[e + 1].progress - way[e].progress < step &&
                    at >= way[e].along && at < way[e + 1].along)
                  {
                    const double t = (at - way[e].along) / (way[e + 1].along - way[e].along);
                    value = std::max(value, (1 - t) * way[e].pressure + t * way[e + 1].pressure);
                  }
              }
          }
      }
    return map;
  }

  double covered_share(const FlankMap &pattern)
  {
    return static_cast<double>((pattern.value.array() > 0).count()) / pattern.value.size();
  }

  FlankMap pinion_modification(const GearPair &pair, const MeshDeviations &deviations)
  {
    return map_of(
        pair.pinion_roll, -pair.pinion.face_width / 2, pair.pinion.face_width / 2,
        [&](const double roll, const double z) { return removed(deviations.pinion.modifications, roll, z); });
  }

  FlankMap gear_modification(const GearPair &pair, const MeshDeviations &deviations)
  {
    const double middle = pair.data.axial_offset, half = pair.gear.face_width / 2;
    return map_of(pair.gear_roll, middle - half, middle + half, [&](const double roll, const double z) {
      return removed(deviations.gear.modifications, roll, z - middle);
    });
  }

  FlankMap sum_of_modifications(const GearPair &pair, const MeshDeviations &deviations)
  {
    return map_of(pair.pinion_roll, pair.face_low, pair.face_high, [&](const double roll, const double z) {
      const double mate = pair.facing_roll(pair.gear, pair.pinion, roll);
      return removed(deviations.pinion.modifications, roll, z) +
             removed(deviations.gear.modifications, mate, z - pair.data.axial_offset);
    });
  }
} // namespace flank
