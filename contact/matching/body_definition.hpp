// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/near_field.hpp"
#include "mesh/gear/gear_pair.hpp"
#include "mesh/segment/tooth_section.hpp"
#include "solver/reduction/body_model.hpp"

#include <string>

namespace flank
{
  /// What the compliance of a body is computed from.
  struct BodyDefinition
  {
    Gear gear;
    SectorResolution resolution;
    BodyModel model;
    int max_offset; ///< teeth on either side whose response to a loaded tooth can be asked for
    NearField near_field;
  };

  /// Names every field that the compliance of a body depends on, each number in full: bodies with equal
  /// identities are one body, or mirror images of each other. What it leaves out of the gear is its name, its
  /// tip edge, and what follows from fields that are in it. The one list of what a body is: keys of stored
  /// operators and the comparison of two bodies come from it.
  std::string identity(const BodyDefinition &body);
} // namespace flank
