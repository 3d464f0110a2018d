// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "contact/flanks/deviations.hpp"

#include <map>

namespace flank
{
  /// The two flanks of a tooth, seen from +z with the tooth pointing up. Left flanks meet left flanks; they
  /// are the loaded ones when the pinion drives counter-clockwise.
  enum class Flank
  {
    left,
    right
  };

  const char *name_of(Flank flank);

  /// One flank of a gear, and on which of its modifications the case's keys act.
  struct FlankInput
  {
    FlankDeviations deviations; ///< its parameters are not numbered yet
    std::map<std::string, std::vector<ModificationParameter>> by_key;
  };

  /// How one flank of a gear is made: what the case gives for it alone replaces what it gives for both.
  /// What is copied from the pinion along z is mirrored; bias corners are copied by function (their face end
  /// follows from the contact lines). Throws InputError.
  FlankInput read_flank(const CaseFile &file, const GearPair &pair, const Gear &gear, const RollAngles &roll,
                        Flank flank);
} // namespace flank
