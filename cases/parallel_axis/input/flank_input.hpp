// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file.hpp"
#include "contact/grid/deviations.hpp"

namespace flank
{
  /// Seen from +z with the tooth pointing up. Left flanks meet left flanks; they are the loaded ones when the pinion drives
  /// counter-clockwise.
  enum class Flank
  {
    left,
    right
  };

  const char *name_of(Flank flank);

  /// How one flank of a gear is made: what the case gives for it alone replaces what it gives for both.
  /// What is copied from the pinion along z is mirrored; bias corners are copied by function (their face end follows from the
  /// contact lines). Throws InputError.
  FlankDeviations read_flank(const CaseFile &file, const GearPair &pair, const Gear &gear, const RollAngles &roll, Flank flank);
} // namespace flank
