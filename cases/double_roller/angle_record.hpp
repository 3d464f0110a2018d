// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/input.hpp"
#include "cases/work/packing.hpp"
#include "contact/rollers/drive_position.hpp"

namespace flank
{
  /// What a run finds at one crank angle, at all torques of its case in their order; or why there is nothing.
  struct CrankAngleResult
  {
    double unloaded_psi = 0, preload = 0;  ///< [rad], [N]
    std::vector<DrivePosition> at;         ///< one a torque
    std::vector<double> secant_gear_ratio; ///< one a torque
    std::vector<std::string> failed;       ///< one a torque: why it has no solution; else empty
    std::string failure;                   ///< of a computation without a result; else empty
  };

  /// A result as bytes, for the journal and for other processes; unpacked it is the same to the last bit.
  void pack(const CrankAngleResult &result, Packer &out);

  /// What pack() wrote. Throws UnusableRecord.
  CrankAngleResult unpack_angle(Unpacker &in);

  /// Whether bytes from a disk are a result of a case at one of its crank angles [rad]: of its torques,
  /// numbers where they can be, pairs of its rollers and sleeves; or a failure.
  bool is_angle(const std::vector<char> &bytes, const DoubleRollerCase &input, double crank_angle);
} // namespace flank
