// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/packing.hpp"
#include "contact/loaded/position_result.hpp"

namespace flank
{
  /// The results of one torque band at one position as bytes, for the journal and for other processes;
  /// unpacked they are the same to the last bit, and share their grid.
  void pack(const std::vector<PositionResult> &band, Packer &out);
  std::vector<PositionResult> unpack_band(Unpacker &in);

  /// Whether bytes from a disk are such results of these torques [N mm] at a phase in each of `cycles` mesh
  /// cycles, finite and certified or with the reason why there is none, and have no fewer measures where they
  /// are loaded.
  bool is_band(const std::vector<char> &bytes, const std::vector<double> &torques, double phase, int cycles,
               std::size_t measures = 0);
} // namespace flank
