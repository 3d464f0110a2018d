// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/deviations.hpp"
#include "contact/loaded/options.hpp"
#include "contact/matching/body_definition.hpp"

#include <memory>
#include <string>
#include <vector>

namespace flank
{
  class Extra;

  /// A parallel-axis case as the physics sees it: [mm, MPa, N mm, rad].
  struct ParallelAxisCase
  {
    std::string title;
    GearPair pair;
    MeshDeviations deviations; ///< of the loaded flanks
    MeshDeviations coast;      ///< of the others; shown by `check`, nothing is computed from them
    Mounting pinion_mounting, gear_mounting;
    SectorResolution pinion_mesh, gear_mesh;
    BodyModel body;
    ContactGridSize grid;
    NearField near_field;
    std::vector<double> torques;
    std::vector<std::string> failures; ///< torques that were left out because they failed, a line each
    int positions;      ///< a mesh cycle
    int cycles;         ///< mesh cycles: 1, or until the same teeth meet again
    std::vector<std::string>
        parameters;    ///< keys of the loaded flanks' modifications, as the deviations number them
    bool derivatives;  ///< whether transmission error is differentiated by them
    std::string level; ///< of accuracy
    std::vector<std::shared_ptr<const Extra>>
        extras; ///< optional outputs that the case asks for; studies leave them out
    std::vector<std::string> not_asked_for; ///< what the plan says of the others

    /// The pinion's, then the gear's where it is another body; the same body or mirror images of each other
    /// need one reduction.
    std::vector<BodyDefinition> bodies() const;

    bool has_tilt_springs() const;
  };
} // namespace flank
