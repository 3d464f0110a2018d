// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/input.hpp"
#include "cases/results/variant.hpp"
#include "contact/rollers/drive_position.hpp"
#include "mesh/base/units.hpp"

#include <vector>

namespace flank
{
  struct DoubleRollerResults;

  /// What stands at the head of every table of a drive.
  inline constexpr const char *drive_conventions =
      "# TE: lag of the carrier behind crank angle / N_s, positive when the carrier lags; in um at the "
      "sleeve "
      "circle radius R1. With backlash = zero (preset paper)\n"
      "# it is counted from where the most advanced pair touches: LTE = d phi - (phi_d - phi/N_s). Crank "
      "counter-clockwise, carrier clockwise.\n"
      "# max_pressure: at mid-roller. edge_pressure: at the roller's ends; where the half-space goes on "
      "beyond them and the contact reaches them it is singular and the value depends on the grid.\n"
      "# A_i = 2|c_i|: peak amplitude of i waves in 360/N_r of the crank, over one period of the drive. That "
      "is 360/N_r where all parts are alike: TE = mean + sum A_i cos(2 pi i t + phase_deg),\n"
      "# t = 0..1 from the first crank angle to 360/N_r on. Errors of single parts make it longer, and bring "
      "waves beside these. Means are over the same period, where the crank angles hold it.\n";

  constexpr double per_arcmin = 60 * units::arcsecond / units::newton_metre; ///< [N mm/rad] to [N m/arcmin]

  /// The greatest values over all pairs of a position: mid-roller and edge pressure [MPa], force [N].
  struct Peaks
  {
    double mid = 0, edge = 0, force = 0;
  };
  Peaks peaks(const DrivePosition &position);

  /// A rotation of the carrier [rad] along the circle of the sleeves. [um]
  double micrometres(const DoubleRollerCase &input, double rotation);

  /// Lags at the first `count` positions. [um]
  std::vector<double> lags_um(const DoubleRollerCase &input, const std::vector<DrivePosition> &positions,
                              std::size_t count);

  /// Torque over the rotation that it winds the carrier up by [N mm/rad]; 0 where the torque acts on the
  /// crank.
  double secant_stiffness(const DoubleRollerCase &input, const DoubleRollerResults &results,
                          std::size_t torque, std::size_t position);

  /// Means over the first whole period of the crank, or over all positions where they hold none.
  struct DriveMeans
  {
    double lag;             ///< transmission error [rad]
    double tangent, secant; ///< stiffness of the carrier's rotation [N mm/rad]
  };
  DriveMeans means(const DoubleRollerCase &input, const DoubleRollerResults &results, std::size_t torque);

  /// The gear ratio as the case's model asks for it: instantaneous, or over a degree of the crank.
  double gear_ratio(const DoubleRollerCase &input, const DoubleRollerResults &results, std::size_t torque,
                    std::size_t position);

  /// Positions of one period of the drive, errors of single parts included, at the start of the crank angles;
  /// 0 where they do not divide or not reach over it.
  std::size_t period_positions(const DoubleRollerCase &input);

  /// What a study keeps of a position.
  StudyPoint study_point(const DoubleRollerCase &input, const DrivePosition &position);

  /// A run as a study sees a variant: torques and crank angles, and [crank angle][torque].
  VariantFrame frame_of(const DoubleRollerCase &input);
  std::vector<StudyPoint> study_points(const DoubleRollerCase &input, const DoubleRollerResults &results);
} // namespace flank
