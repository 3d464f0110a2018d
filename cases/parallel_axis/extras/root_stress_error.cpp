// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/root_stress_error.hpp"

#include "contact/stress/body_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace flank
{
  namespace
  {
    /// Greatest principal stress in both fillets of one tooth under the contact forces of a position. [MPa]
    double greatest_root_stress(LoadedBodies &bodies, const Side side, const PositionResult &position,
                                const int pair)
    {
      const std::size_t body = bodies.of(side);
      const BodyCompliance &compliance = *bodies.bodies()[body];
      const TeethLoads loads = flank_loads(compliance.far_field().surface, position, side);
      const int tooth = side == Side::pinion ? pair : -pair;
      const LoadedTeeth &inside = bodies.inside(body);
      const CutDisplacements cuts = inside.cuts({ loads }, { tooth });
      const auto stress =
          bodies.fillets(body).greatest(inside.displacement(loads, tooth, cuts.front().at(tooth)));
      double greatest = 0;
      for (const std::vector<double> &fillet : stress)
        for (const double value : fillet)
          greatest = std::max(greatest, value);
      return greatest;
    }

    struct BentTooth
    {
      const PositionResult *position = nullptr;
      int pair = 0;
      double bending = 0; ///< load times roll angle [N rad]
    };

    /// Load times roll angle on its own flank of the teeth of a body, by pair. [N rad]
    std::map<int, double> bending_of_teeth(const GearPair &pair, const PositionResult &position,
                                           const Side side)
    {
      std::map<int, double> bending;
      for (const LineLoad &line : position.lines)
        bending[line.pair] +=
            line.load_per_length * line.height *
            (side == Side::pinion ? line.pinion_roll
                                  : pair.facing_roll(pair.gear, pair.pinion, line.pinion_roll));
      return bending;
    }

    /// The tooth of a body for which that is greatest.
    BentTooth most_bent(const GearPair &pair, const std::vector<PositionResult> &positions, const Side side)
    {
      BentTooth most;
      for (const PositionResult &position : positions)
        {
          if (!position.contact_cells) // of later mesh cycles none are kept
            continue;
          for (const auto &[of_pair, value] : bending_of_teeth(pair, position, side))
            if (value > most.bending)
              most = { &position, of_pair, value };
        }
      return most;
    }
  } // namespace

  double greatest_bending(const GearPair &pair, const PositionResult &position, const Side side)
  {
    double greatest = 0;
    for (const auto &[of_pair, value] : bending_of_teeth(pair, position, side))
      greatest = std::max(greatest, value);
    return greatest;
  }

  std::array<double, 2> root_stress_differences(const GearPair &pair,
                                                const std::vector<PositionResult> &positions,
                                                LoadedBodies &bodies, LoadedBodies &coarser)
  {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 2> differences = { unknown, unknown };
    for (const Side side : { Side::pinion, Side::gear })
      if (const BentTooth most = most_bent(pair, positions, side); most.position)
        {
          const double fine = greatest_root_stress(bodies, side, *most.position, most.pair),
                       coarse = greatest_root_stress(coarser, side, *most.position, most.pair);
          differences[side == Side::gear] = fine > 0 ? std::abs(coarse / fine - 1) : unknown;
        }
    return differences;
  }
} // namespace flank
