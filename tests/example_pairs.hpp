// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/units.hpp"
#include "mesh/gear/gear_pair.hpp"

#include <limits>

/// The 50/50 pair of Wagaj and Kahraman (2002), table 1; bore and fillet as the ready cases state them.
inline flank::PairData paper_pair(const double helix_angle_deg)
{
  flank::PairData data;
  data.centre_distance = 150;
  data.transverse_module = 3;
  data.transverse_pressure_angle = 20 * flank::units::degree;
  data.helix_angle = helix_angle_deg * flank::units::degree;
  data.pinion = { "pinion", 50,  20,    78, 70.34, 4.64, std::numeric_limits<double>::quiet_NaN(),
                  35.17,    1.0, 207e3, 0.3 };
  data.gear = data.pinion;
  data.gear.name = "gear";
  return data;
}

/// That pair with another gear: 50 and 56 teeth, helix angle 15 deg.
inline flank::PairData unequal_pair()
{
  flank::PairData data = paper_pair(15);
  data.gear.teeth = 56;
  data.centre_distance = 159;
  data.gear.tip_radius = 87;
  data.gear.root_radius = 79.3;
  data.gear.bore_radius = 40;
  return data;
}

/// A small gear whose whole body can be solved directly.
inline flank::PairData twelve_tooth_pair(const double helix_angle_deg)
{
  flank::PairData data = paper_pair(helix_angle_deg);
  data.centre_distance = 37.2;
  data.pinion = { "pinion", 12, 10,  21,    14.6, std::numeric_limits<double>::quiet_NaN(),
                  0.2,      6,  0.8, 207e3, 0.3 };
  data.gear = data.pinion;
  data.gear.name = "gear";
  return data;
}
