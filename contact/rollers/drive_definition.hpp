// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/drive_supports.hpp"
#include "contact/rollers/roller_contact.hpp"
#include "mesh/gear/double_roller.hpp"

namespace flank
{
  /// Which gaps the pairs have. One of the choices is that of the double-roller actuator article
  /// (bibliography in contact/bibliography.md).
  enum class Backlash
  {
    exact,      ///< gaps of all pairs on both flanks as the geometry has them
    drive_only, ///< the same, but pairs of the coast flank carry nothing
    zero        ///< every drive pair touches unloaded: approach = lever times rotation, as in the article
  };

  /// Choices of the model; those that the article makes are among them.
  struct DoubleRollerModel
  {
    Backlash backlash = Backlash::exact;
    bool window = false; ///< candidates: sleeves at polar angles (-g/2, pi) from the crank, each with its
                         ///< nearest drive roller; else all
    bool drop_interfering = false; ///< pairs that overlap at the nominal rotation carry nothing
    bool linear = false;           ///< gaps linear about psi = phi/N_s; else exact at the contact position
    bool secant_ratio = false;     ///< gear ratio by secant over one degree; else by implicit differentiation
    bool input_torque = false;     ///< torques act on the crank; else on the carrier
    bool conjugate = false;        ///< sleeves with the conjugate profile instead of circles
  };

  /// A double-roller drive as its load balance needs it. [mm, MPa, N mm, rad]
  struct DriveDefinition
  {
    DoubleRollerData drive;
    RollerContactData contact; ///< of one roller and one sleeve
    RollerGridSize grid;       ///< of their contact
    DoubleRollerModel model;
    DriveSupports supports;
  };
} // namespace flank
