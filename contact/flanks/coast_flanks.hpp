// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/deviations.hpp"

namespace flank
{
  /// What takes the backlash of a pair whose drive flanks just touch, along the normal of the flanks. [mm]
  struct BacklashTaken
  {
    double by_tilts, by_single_teeth, by_runout;

    double sum() const { return by_tilts + by_single_teeth + by_runout; }
  };

  /// What may be taken before the coast flanks touch, whose contact is not computed: the backlash along the
  /// normal. Gears without any are given by their nominal data, and are made with some: up to a tenth of the
  /// module is left to them. [mm]
  double backlash_to_take(const GearPair &pair);

  /// What the coast flanks of a pair deviate by, modifications alone, and in how many mesh cycles they meet.
  struct CoastFlanks
  {
    FlankDeviations pinion, gear;
    int cycles = 1;
    double taken_otherwise = 0; ///< of the backlash, by single teeth and runout, where that is known [mm]
  };

  /// An upper bound, whatever modifications the flanks have: tilts over the whole face and all teeth against
  /// each other.
  BacklashTaken most_backlash_taken(const GearPair &pair, const MeshDeviations &drive);

  /// The greatest over the mesh cycles, with the flanks as they are: crowns and helix slopes of both sides
  /// take up what a tilt does. Tilts count by the least gaps of both sides, each at the same rotation of the
  /// tilted axes; single teeth by drive and coast flanks that are in mesh at the same time (a tooth stands
  /// back as a whole, so its coast flank stands forward); runout with both gears closest to each other.
  BacklashTaken backlash_taken(const GearPair &pair, const MeshDeviations &drive, const CoastFlanks &coast);
} // namespace flank
