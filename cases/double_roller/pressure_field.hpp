// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/results.hpp"
#include "solver/elements/field_piece.hpp"

namespace flank
{
  /// Contact pressures of the loaded pairs of one crank angle on the surfaces of rollers and sleeves, in
  /// place. [mm, MPa, N]
  FieldPiece pressure_field(const LoadedDrive &drive, const DrivePosition &position);

  /// The cylinders of all rollers and sleeves in place (circular sleeves; of a conjugate profile the rollers
  /// alone).
  FieldPiece drive_shape(const DoubleRollerCase &input, const LoadedDrive &drive,
                         const DrivePosition &position);

  /// Writes fields/ of the result folder: both of them for each angle of the pressure maps at each torque,
  /// PVD series over the crank angle. Throws ComputationError.
  void write_pressure_fields(const ResultFolder &folder, const DoubleRollerCase &input,
                             const LoadedDrive &drive, const DoubleRollerResults &results);
} // namespace flank
