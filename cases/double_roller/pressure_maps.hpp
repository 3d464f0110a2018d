// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "solver/elements/field_piece.hpp"

namespace flank
{
  class Hdf5File;
  class LoadedDrive;
  class ResultFolder;
  struct DoubleRollerCase;
  struct DoubleRollerResults;
  struct DrivePosition;

  /// The drive's optional output: contact pressures of the loaded pairs at some crank angles, in results.h5
  /// and for ParaView. Its keys, its words in the plan and what it writes all stand in pressure_maps.cpp.
  class PressureMaps
  {
  public:
    static std::vector<Key> keys();

    PressureMaps() = default;

    /// What a case asks for among its crank angles [rad]. Throws InputError.
    PressureMaps(const CaseFile &file, const std::vector<double> &crank_angles);

    /// What the plan says is left out.
    std::string left_out() const;

    /// A group a pair in results.h5.
    void write(Hdf5File &out, const LoadedDrive &drive, const DoubleRollerResults &results) const;

    /// fields/ of the result folder, where they are asked for: pressure_field() and drive_shape() of each
    /// angle at each torque, PVD series over the crank angle. Throws ComputationError.
    void write_fields(const ResultFolder &folder, const DoubleRollerCase &input, const LoadedDrive &drive,
                      const DoubleRollerResults &results) const;

  private:
    std::vector<std::size_t> positions_; ///< numbers of the crank angles
    bool fields_ = false;                ///< whether these are written for ParaView too
  };

  /// Contact pressures of the loaded pairs of one crank angle on the surfaces of rollers and sleeves, in
  /// place. [mm, MPa, N]
  FieldPiece pressure_field(const LoadedDrive &drive, const DrivePosition &position);

  /// The cylinders of all rollers and sleeves in place (circular sleeves; of a conjugate profile the rollers
  /// alone).
  FieldPiece drive_shape(const DoubleRollerCase &input, const LoadedDrive &drive,
                         const DrivePosition &position);
} // namespace flank
