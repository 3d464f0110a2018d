// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/roller_pair/input.hpp"
#include "cases/work/result_folder.hpp"

#include <string>
#include <utility>
#include <vector>

namespace flank
{
  /// The contact at one force, and Hertz's formulas beside it.
  struct RollerPairResult
  {
    double force = 0; ///< [N]
    RollerPairContact contact;
    half_space::SubsurfaceStress subsurface; ///< below the greatest pressure
    HertzReference reference;
  };

  /// Solves the contact at every force of the case, in the case's order. Throws ComputationError.
  std::vector<RollerPairResult> run_roller_pair(const RollerPairCase &input);

  std::string summary(const RollerPairCase &input, const std::vector<RollerPairResult> &results);

  /// Writes contact.csv, results.h5, case.toml and summary.txt. stages: names and wall times [s]. Throws
  /// OutputError.
  void write_results(const ResultFolder &folder, const CaseFile &file, const RollerPairCase &input,
                     const std::vector<RollerPairResult> &results,
                     const std::vector<std::pair<std::string, double>> &stages, const std::string &versions);
} // namespace flank
