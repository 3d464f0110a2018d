// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/mesh_cycle.hpp"
#include "tests/example_pairs.hpp"

// Draft bodies of the helical example and of its spur sister: the identities tested with them hold for any mesh.

inline flank::SectorResolution small_sector()
{
  flank::SectorResolution size;
  size.flank_rows = 6, size.tooth_columns = 4, size.face_layers = 6, size.rim_layers = 5;
  return size;
}

constexpr flank::ContactGridSize small_grid{ 15, 11 };

/// helix_angle: 0, or anything else for 25.232 deg.
inline const flank::BodyCompliance &small_body(const double helix_angle)
{
  const auto make = [](const double degrees) {
    return flank::BodyCompliance(flank::make_gear_pair(paper_pair(degrees)).pinion, small_sector(), 6);
  };
  if (helix_angle == 0)
    {
      static const flank::BodyCompliance spur = make(0);
      return spur;
    }
  static const flank::BodyCompliance helical = make(25.232);
  return helical;
}

inline double te(const flank::GearPair &pair, const flank::PositionResult &result)
{
  return flank::transmission_error_um(pair, result);
}
