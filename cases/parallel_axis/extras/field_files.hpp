// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/extras/loaded_bodies.hpp"
#include "cases/parallel_axis/mesh_cycle.hpp"
#include "cases/results/result_folder.hpp"

namespace flank
{
  class ParallelSession;

  /// Writes fields/ of the result folder for what the case asks: VTU files of each position and torque, one
  /// PVTU over both bodies, PVD series over the positions, and a view for ParaView. The ranks take the
  /// positions in turn; the files are the same on any number. Collective. Throws ComputationError.
  void write_fields(const ParallelAxisCase &input, LoadedBodies &bodies, const ResultFolder &folder,
                    const ParallelSession &session);
} // namespace flank
