// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "contact/rollers/roller_pair.hpp"

namespace flank
{
  /// A case of two rollers as the physics sees it: [mm, MPa, N, rad].
  struct RollerPairCase
  {
    std::string title;
    RollerPairData rollers;
    RollerPairGrid grid;
    std::vector<double> forces;
  };

  /// Throws InputError with file, line, key and value.
  RollerPairCase read_roller_pair(const CaseFile &file);

  /// The report of `flank check`: curvatures, and Hertz's formulas at every force.
  std::string roller_pair_report(const RollerPairCase &input);
} // namespace flank
