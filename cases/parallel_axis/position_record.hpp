// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/packing.hpp"
#include "cases/parallel_axis/loaded_mesh.hpp"

namespace flank
{
  /// A result as bytes, for the journal and for other processes; unpacked it is the same to the last bit.
  void           pack(const PositionResult &result, Packer &out);
  PositionResult unpack_position(Unpacker &in);
} // namespace flank
