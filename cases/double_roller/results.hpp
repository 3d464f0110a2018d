// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/drive_measures.hpp"
#include "cases/double_roller/input.hpp"
#include "cases/work/result_folder.hpp"
#include "cases/work/shared_work.hpp"
#include "contact/rollers/drive_position.hpp"

namespace flank
{
  /// Everything one run found: at[torque][crank angle].
  struct DoubleRollerResults
  {
    std::vector<double> torques;       ///< those of the case that have results [N mm]
    std::vector<std::string> failures; ///< of the others, a line each
    std::vector<std::vector<DrivePosition>> at;
    std::vector<std::vector<double>> secant_gear_ratio; ///< [torque][crank angle]
    std::vector<double> unloaded_psi, preload;          ///< over crank angles [rad], [N]
    std::vector<std::pair<std::string, double>> stage_seconds;
  };

  /// The work of a run for each of so many processes, in the operations of operations_a_second(): the laws of
  /// circles (one) or conjugate profiles (a ladder of radii), which every process makes, then its share of
  /// the angles at each torque. Fitted by `validation/run plan`.
  double operations(const DoubleRollerCase &input, int processes = 1);

  /// Memory of a run: the cells of a quarter of a pair, their compliance and its factor, and the positions
  /// with their pairs. [bytes]
  double bytes_needed(const DoubleRollerCase &input);

  /// All crank angles at all torques, each angle a job of the shared work: on rank 0, empty on the others.
  /// A torque without a solution at some crank angle is left out and told. Throws SharedComputationError on
  /// all processes where none is left, of the first one. Collective.
  DoubleRollerResults run_double_roller(const DoubleRollerCase &input, const LoadedDrive &drive,
                                        const SharedWork &work = SharedWork(nullptr, nullptr));

  std::string summary(const DoubleRollerCase &input, const DoubleRollerResults &results);

  /// Writes te.csv, harmonics.csv, pairs.csv, unloaded.csv, results.h5 and case.toml; design_torques.csv and
  /// amplitudes_over_torque.csv where several torques are loaded; summary.txt is the last.
  void write_results(const ResultFolder &folder, const CaseFile &file, const DoubleRollerCase &input,
                     const LoadedDrive &drive, const DoubleRollerResults &results,
                     const std::string &versions);
} // namespace flank
