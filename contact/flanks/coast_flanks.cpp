// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/coast_flanks.hpp"

#include "contact/flanks/mesh_position.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr int phases = 8, slices = 61;

    /// The tilt that the coast flanks see, which press at 2 alpha to the drive flanks: a point of the pinion
    /// moved by u opens them by -u.n and moves towards the gear by u.t, n and t along and across their line
    /// of action.
    Misalignment on_coast_flanks(const Misalignment &tilt, const double alpha)
    {
      return { .in_plane = -(tilt.in_plane * std::cos(2 * alpha) + tilt.across * std::sin(2 * alpha)),
               .across = tilt.across * std::cos(2 * alpha) - tilt.in_plane * std::sin(2 * alpha) };
    }

    /// Least gap on the path of action at a phase, of flanks that stand back as nothing but modifications and
    /// tilts make them. [mm]
    double least_gap(const GearPair &pair, const MeshDeviations &deviations, const double phase)
    {
      double least = 1e300;
      for (const Slice &slice : MeshPosition(pair, deviations, phase).slices(slices))
        if (!slice.tip_edge)
          least = std::min(least, slice.touch);
      return least;
    }

    double by_runout(const GearPair &pair, const MeshDeviations &drive)
    {
      return (drive.pinion.runout + drive.gear.runout) * std::sin(pair.working_pressure_angle) *
             std::cos(pair.base_helix_angle);
    }

    double spread(const std::vector<double> &errors)
    {
      const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
      return errors.empty() ? 0 : *most - *least;
    }

    double by_tilts(const GearPair &pair, const MeshDeviations &drive, const FlankDeviations &coast_pinion,
                    const FlankDeviations &coast_gear)
    {
      if (drive.misalignment.in_plane == 0 && drive.misalignment.across == 0)
        return 0;
      PairData turned = pair.data;
      turned.counter_clockwise_drive = !turned.counter_clockwise_drive;
      const GearPair coast_pair = make_gear_pair(turned);
      MeshDeviations driven, coasting;
      driven.pinion.modifications = drive.pinion.modifications;
      driven.gear.modifications = drive.gear.modifications;
      coasting.pinion.modifications = coast_pinion.modifications;
      coasting.gear.modifications = coast_gear.modifications;
      const auto least_gaps = [&](const Misalignment &tilt) {
        driven.misalignment = tilt;
        coasting.misalignment = on_coast_flanks(tilt, pair.working_pressure_angle);
        double of_drive = -1e300, of_coast = -1e300;
        for (int i = 0; i < phases; ++i)
          {
            of_drive = std::max(of_drive, least_gap(pair, driven, 1.0 * i / phases));
            of_coast = std::max(of_coast, least_gap(coast_pair, coasting, 1.0 * i / phases));
          }
        return of_drive + of_coast;
      };
      // What the flanks keep apart without a tilt is not taken by it.
      return std::max(0.0, least_gaps({}) - least_gaps(drive.misalignment));
    }

    /// Pairs k whose phase + k lies in a window. [pitches]
    std::vector<int> pairs_within(const double low, const double high, const double phase)
    {
      std::vector<int> pairs;
      constexpr double rounding = 1e-9;
      for (int k = static_cast<int>(std::ceil(low - phase - rounding)); k + phase <= high + rounding; ++k)
        pairs.push_back(k);
      return pairs;
    }

    /// Drive flanks of a pair are in mesh from phase -before to after. Teeth are symmetric, so coast flanks
    /// are in mesh where the tooth's mirror image has its drive flanks: half a pitch on, the window reversed.
    /// The pinion's tooth of pair k has its coast flank on the gear's tooth of the pair behind, k - 1.
    double by_single_teeth(const GearPair &pair, const MeshDeviations &drive, const int cycles)
    {
      if (drive.pinion.index_errors.empty() && drive.gear.index_errors.empty())
        return 0;
      double before = 0, after = 0;
      const MeshDeviations none;
      for (int i = 0; i < phases; ++i)
        for (const Slice &slice : MeshPosition(pair, none, 1.0 * i / phases).slices(slices))
          if (!slice.tip_edge)
            {
              before = std::max(before, -slice.pair - 1.0 * i / phases);
              after = std::max(after, slice.pair + 1.0 * i / phases);
            }
      MeshDeviations of_pinion, of_gear;
      of_pinion.pinion.index_errors = drive.pinion.index_errors;
      of_gear.gear.index_errors = drive.gear.index_errors;
      double greatest = 0;
      for (int i = 0; i < phases; ++i)
        {
          const double phase = 1.0 * i / phases;
          const std::vector<int> driving = pairs_within(-before, after, phase),
                                 coasting = pairs_within(0.5 - after, 0.5 + before, phase);
          for (int cycle = 0; cycle < cycles; ++cycle)
            {
              double least = 1e300, most = -1e300;
              for (const int k : driving)
                least = std::min(least, of_pinion.stand_back(pair, k, cycle, 0).sum() +
                                            of_gear.stand_back(pair, k, cycle, 0).sum());
              for (const int k : coasting)
                most = std::max(most, of_pinion.stand_back(pair, k, cycle, 0).sum() +
                                          of_gear.stand_back(pair, k - 1, cycle, 0).sum());
              greatest = std::max(greatest, most - least);
            }
        }
      return greatest;
    }
  } // namespace

  double backlash_to_take(const GearPair &pair)
  {
    const double backlash =
                     pair.backlash * std::cos(pair.working_pressure_angle) * std::cos(pair.base_helix_angle),
                 module = pair.data.transverse_module;
    return backlash > 1e-3 * module ? backlash : 0.1 * module;
  }

  BacklashTaken most_backlash_taken(const GearPair &pair, const MeshDeviations &drive)
  {
    const Misalignment coast = on_coast_flanks(drive.misalignment, pair.working_pressure_angle);
    return { .by_tilts = (std::abs(drive.misalignment.in_plane) + std::abs(coast.in_plane)) / 2 *
                         pair.common_face_width,
             .by_single_teeth = spread(drive.pinion.index_errors) + spread(drive.gear.index_errors),
             .by_runout = by_runout(pair, drive) };
  }

  BacklashTaken backlash_taken(const GearPair &pair, const MeshDeviations &drive, const CoastFlanks &coast)
  {
    return { .by_tilts = by_tilts(pair, drive, coast.pinion, coast.gear),
             .by_single_teeth = by_single_teeth(pair, drive, coast.cycles),
             .by_runout = by_runout(pair, drive) };
  }
} // namespace flank
