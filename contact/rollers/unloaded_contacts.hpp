// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/drive_position.hpp"

#include <vector>

namespace flank
{
  /// A roller and a sleeve of the unloaded drive, and where they would touch.
  struct UnloadedContact
  {
    int roller, sleeve;
    DriveFlank flank;
    double rotation; ///< of the carrier, at which they touch [rad]
    double backlash; ///< behind (drive flank) or ahead of (coast flank) the first to touch [rad]
    double gap;      ///< at the nominal rotation [mm]
    double lever;    ///< where they touch [mm]
    double first;    ///< rotation at which the first pair of this flank touches [rad]
  };

  /// The contacts of the unloaded drive at a crank angle [rad]. Of circular sleeves every pair within a
  /// quarter pitch of its contact on the flank it is on; a pair at its reversal, without a lever, is on
  /// neither flank. Of conjugate profiles every pair, in contact at the nominal rotation.
  std::vector<UnloadedContact> unloaded_contacts(const LoadedDrive &drive, bool conjugate,
                                                 double crank_angle);
} // namespace flank
