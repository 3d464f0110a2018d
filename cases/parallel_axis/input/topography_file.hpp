// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "mesh/gear/gear_pair.hpp"
#include "mesh/gear/topography.hpp"

#include <memory>

namespace flank
{
  /// Reads the table that `key` names: comma-separated; lines that start with # are left out; the first line
  /// is "removed_um(X,z_mm)", X being roll_angle_deg, diameter_mm or length_of_roll_mm, followed by the face
  /// positions; every further line is one X followed by the material removed at each face position. Both
  /// ascend. mirrored: the table of the other gear, taken over with z reversed. Throws InputError for a table
  /// with holes, or one that does not cover the active profile over the common face width.
  std::shared_ptr<const Topography> read_topography(const CaseFile &file, const std::string &key,
                                                    const GearPair &pair, const Gear &gear,
                                                    const RollAngles &roll, bool mirrored);
} // namespace flank
