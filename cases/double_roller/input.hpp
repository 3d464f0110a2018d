// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file.hpp"
#include "cases/double_roller/roller_contact.hpp"
#include "mesh/gear/double_roller.hpp"

namespace flank
{
  enum class Backlash
  {
    exact,      ///< gaps of all pairs on both flanks as the geometry has them
    drive_only, ///< the same, but pairs of the coast flank carry nothing
    zero        ///< every drive pair touches unloaded: approach = lever times rotation (the paper)
  };

  /// What the model takes part of; each choice of the paper is one of these.
  struct DoubleRollerModel
  {
    Backlash backlash = Backlash::exact;
    bool window = false; ///< candidates: sleeves at polar angles (-g/2, pi) from the crank, each with its nearest drive roller; else all
    bool drop_interfering = false; ///< pairs that overlap at the nominal rotation carry nothing
    bool linear           = false; ///< gaps linear about psi = phi/N_s; else exact at the contact position
    bool secant_ratio     = false; ///< gear ratio by secant over one degree; else by implicit differentiation
    bool input_torque     = false; ///< torques act on the crank; else on the carrier
    bool conjugate        = false; ///< sleeves with the conjugate profile instead of circles
  };

  /// A double-roller case as the physics sees it: [mm, MPa, N mm, rad].
  struct DoubleRollerCase
  {
    std::string              title;
    DoubleRollerData         drive;
    RollerContactData        contact;
    RollerGridSize           grid;
    DoubleRollerModel        model;
    std::vector<double>      torques;
    std::vector<double>      crank_angles;
    std::vector<double>      map_angles;              ///< for which pressure maps are kept
    bool                     pressure_fields = false; ///< whether these are written for ParaView too
    std::vector<std::string> warnings;
  };

  /// Throws InputError with file, line, key and value.
  DoubleRollerCase read_double_roller(const CaseFile &file);

  /// The report of `flank check`.
  std::string drive_report(const DoubleRollerCase &input);
} // namespace flank
