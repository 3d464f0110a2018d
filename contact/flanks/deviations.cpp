// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/deviations.hpp"

#include "mesh/base/units.hpp"
#include "mesh/gear/involute.hpp"

#include <algorithm>
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

  double ParameterScale::own(const double key) const
  {
    return kind == Kind::multiple         ? key * factor
           : kind == Kind::length_of_roll ? key / base_radius
                                          : roll_angle(key / 2, base_radius);
  }

  double ParameterScale::slope(const double key) const
  {
    return kind == Kind::multiple         ? factor
           : kind == Kind::length_of_roll ? 1 / base_radius
                                          : key / (4 * base_radius * base_radius * own(key));
  }

  FlankDeviations FlankDeviations::with(const std::vector<double> &values) const
  {
    FlankDeviations result = *this;
    for (std::size_t k = 0; k < values.size(); ++k)
      for (const ModificationParameter &acting : parameters[k])
        {
          const auto number = std::find(modifications.begin(), modifications.end(), acting.modification) -
                              modifications.begin();
          auto &changed = result.modifications[static_cast<std::size_t>(number)];
          changed = changed->with(acting.by, acting.scale.own(values[k]));
        }
    for (std::size_t k = 0; k < values.size(); ++k)
      for (ModificationParameter &acting : result.parameters[k])
        {
          const auto number = std::find(modifications.begin(), modifications.end(), acting.modification) -
                              modifications.begin();
          acting.modification = result.modifications[static_cast<std::size_t>(number)];
          acting.value = values[k];
        }
    return result;
  }

  std::vector<double> MeshDeviations::values() const
  {
    std::vector<double> result;
    for (std::size_t k = 0; k < n_parameters(); ++k)
      result.push_back((pinion.parameters[k].empty() ? gear : pinion).parameters[k].front().value);
    return result;
  }

  MeshDeviations MeshDeviations::with(const std::vector<double> &values) const
  {
    return { pinion.with(values), gear.with(values), misalignment };
  }

  StandBack MeshDeviations::stand_back(const GearPair &pair, const int k, const int cycle,
                                       const double phase) const
  {
    return { .pinion = of_gear(pinion, pair.pinion, k, cycle, phase),
             .gear = of_gear(gear, pair.gear, k, cycle, phase) };
  }
} // namespace flank
