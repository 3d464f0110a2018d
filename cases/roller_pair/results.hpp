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

  /// What a run found: the contacts, in the order of the case's forces; forces that have none, a line each.
  struct RollerPairRun
  {
    std::vector<RollerPairResult> results;
    std::vector<std::string> failures;
  };

  /// Solves the contact at every force of the case. Throws ComputationError where none has a solution.
  RollerPairRun run_roller_pair(const RollerPairCase &input);

  std::string summary(const RollerPairCase &input, const RollerPairRun &run);

  /// Writes contact.csv, results.h5, case.toml and summary.txt. stages: names and wall times [s]. Throws
  /// OutputError.
  void write_results(const ResultFolder &folder, const CaseFile &file, const RollerPairCase &input,
                     const RollerPairRun &run, const std::vector<std::pair<std::string, double>> &stages,
                     const std::string &versions);
} // namespace flank
