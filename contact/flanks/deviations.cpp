// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/deviations.hpp"

#include "mesh/base/units.hpp"

#include <cmath>

namespace flank
{
  namespace
  {
    /// Tooth in the order of meshing: pair k meets one pitch before pair k - 1, and each cycle moves on by
    /// one tooth.
    double of_gear(const FlankDeviations &flanks, const Gear &gear, const int k, const int cycle,
                   const double phase)
    {
      double sum = 0;
      if (!flanks.index_errors.empty())
        {
          const int teeth = static_cast<int>(flanks.index_errors.size());
          sum += flanks.index_errors[((cycle - k) % teeth + teeth) % teeth];
        }
      // A displacement e of the gear along the line of action moves every flank by e cos(beta_b) along its
      // normal.
      if (flanks.runout != 0)
        sum += flanks.runout / 2 * std::cos(gear.base_helix_angle) *
               std::cos((cycle + phase) * gear.pitch_angle() - flanks.runout_angle);
      return sum;
    }
  } // namespace

  double MeshDeviations::stand_back(const GearPair &pair, const int k, const int cycle,
                                    const double phase) const
  {
    return of_gear(pinion, pair.pinion, k, cycle, phase) + of_gear(gear, pair.gear, k, cycle, phase);
  }
} // namespace flank
