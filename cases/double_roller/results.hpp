// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/input.hpp"
#include "cases/results/result_folder.hpp"
#include "cases/study/study_work.hpp"
#include "contact/rollers/drive_position.hpp"

namespace flank
{
  /// Everything one run found: at[torque][crank angle].
  struct DoubleRollerResults
  {
    std::vector<std::vector<DrivePosition>> at;
    std::vector<double>                     unloaded_psi, preload; ///< over crank angles [rad], [N]
    double                                  certificate = 0; ///< worst of the pair laws' contact solutions
    std::vector<std::pair<std::string, double>> stage_seconds;
  };

  /// Positions of one period at the start of the crank angles; 0 where they do not divide it.
  std::size_t period_positions(const DoubleRollerCase &input);

  /// Indices of the crank angles whose pressure maps are kept.
  std::vector<std::size_t> map_positions(const DoubleRollerCase &input);

  /// What a study keeps of a position.
  StudyPoint study_point(const DoubleRollerCase &input, const DrivePosition &position);

  /// A run as a study sees a variant: torques and crank angles, and [crank angle][torque].
  VariantFrame            frame_of(const DoubleRollerCase &input);
  std::vector<StudyPoint> study_points(const DoubleRollerCase &input, const DoubleRollerResults &results);

  /// Expected seconds of one core, measured with the presets: the laws of circles (one) or conjugate profiles
  /// (a ladder of radii), then each angle at each torque.
  double core_seconds(const DoubleRollerCase &input);

  /// A quarter of a pair's cells, their compliance and its factor; positions with their pairs. [bytes]
  double bytes_needed(const DoubleRollerCase &input);

  DoubleRollerResults run_double_roller(const DoubleRollerCase &input, const LoadedDrive &drive);

  std::string summary(const DoubleRollerCase &input, const DoubleRollerResults &results);

  /// Writes unloaded.csv, te.csv, harmonics.csv, pairs.csv, results.h5, case.toml; summary.txt is the last.
  void write_results(const ResultFolder &folder, const CaseFile &file, const DoubleRollerCase &input,
                     const LoadedDrive &drive, const DoubleRollerResults &results,
                     const std::string &versions);
} // namespace flank
