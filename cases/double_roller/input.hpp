// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "contact/rollers/drive_definition.hpp"

namespace flank
{
  /// A double-roller case as the physics sees it: [mm, MPa, N mm, rad].
  struct DoubleRollerCase : DriveDefinition
  {
    std::string title;
    std::vector<double> torques;
    std::vector<double> crank_angles;
    std::vector<double> map_angles; ///< for which pressure maps are kept
    bool pressure_fields = false;   ///< whether these are written for ParaView too
    std::vector<std::string> warnings;
  };

  /// Throws InputError with file, line, key and value.
  DoubleRollerCase read_double_roller(const CaseFile &file);

  /// Whether two crank angles are one. [rad]
  bool is_same_angle(double one, double other);

  /// The report of `flank check`.
  std::string drive_report(const DoubleRollerCase &input);
} // namespace flank
