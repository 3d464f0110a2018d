// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/pressure_maps.hpp"
#include "contact/rollers/drive_definition.hpp"

namespace flank
{
  /// A double-roller case as the physics sees it: [mm, MPa, N mm, rad].
  struct DoubleRollerCase : DriveDefinition
  {
    std::string title;
    std::vector<double> torques;
    std::vector<double> crank_angles;
    PressureMaps pressure_maps;
    std::vector<std::string> warnings;
  };

  /// Throws InputError with file, line, key and value.
  DoubleRollerCase read_double_roller(const CaseFile &file);

  /// The report of `flank check`.
  std::string drive_report(const DoubleRollerCase &input);
} // namespace flank
