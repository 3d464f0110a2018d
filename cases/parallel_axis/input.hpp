// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file.hpp"
#include "cases/parallel_axis/loaded_mesh.hpp"

namespace flank
{
  /// A parallel-axis case as the physics sees it: [mm, MPa, N mm, rad].
  struct ParallelAxisCase
  {
    std::string         title;
    GearPair            pair;
    FlankModifications  pinion_modifications, gear_modifications;
    SectorResolution    pinion_mesh, gear_mesh;
    ContactGridSize     grid;
    Split               split;
    ClassicalDepth      classical_depth;
    std::vector<double> torques;
    int                 positions;

    /// The gears are the same body or mirror images of each other: one reduction serves both.
    bool identical_bodies() const;
  };

  /// Throws InputError with file, line, key and value.
  ParallelAxisCase read_parallel_axis(const CaseFile &file);
} // namespace flank
