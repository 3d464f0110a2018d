// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair_case.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/shared_work.hpp"
#include "contact/loaded/loaded_pair.hpp"

#include <string>
#include <utility>
#include <vector>

namespace flank
{
  /// Greatest tensile stress in one fillet of one loaded tooth at one place of the face.
  struct RootStress
  {
    int    torque, position; ///< numbers among the case's
    int    body;             ///< 0 pinion, 1 gear
    int    pair;             ///< tooth pair
    int    other_side;       ///< 0: the fillet below the loaded flank, 1: the other one
    double z;                ///< user's z [mm]
    double stress;           ///< greatest principal stress over the fillet, tension positive [MPa]
  };

  /// How much results at one torque differ from those of another accuracy level; absolute values.
  struct ErrorEstimate
  {
    double mean, oscillation;            ///< of TE: its mean, root mean square of the rest [um]
    double peak_to_peak, first_harmonic; ///< of TE [um]
    double pressure;                     ///< greatest inside the flanks, over that of this level
  };

  /// Everything one run found: at[torque][position], positions of all mesh cycles in their order.
  struct ParallelAxisResults
  {
    std::vector<std::vector<PositionResult>> at;
    std::vector<std::vector<PositionResult>>
                               light;          ///< at 1 % of each torque, first mesh cycle, where asked for
    std::vector<RootStress>    root_stress;    ///< where asked for
    std::vector<ErrorEstimate> error_estimate; ///< of each torque, where asked for
    std::vector<std::pair<std::string, double>> stage_seconds; ///< names and wall times
    std::vector<std::shared_ptr<const BodyCompliance>>
        bodies; ///< the pinion, then the gear where it is another body; on every rank
    int unknowns_pinion = 0, unknowns_gear = 0;
  };

  /// Transmission error along the transverse line of action. [um]
  double transmission_error_um(const GearPair &pair, const PositionResult &result);

  /// Tangent mesh stiffness d(T/r_b)/d eps. [N/um]
  double mesh_stiffness(const GearPair &pair, const PositionResult &result);

  /// Reduces the bodies (one of them where they are the same) and rolls through the mesh cycle. Complete on
  /// rank 0 only. Throws ComputationError.
  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input, const SharedWork &work);
} // namespace flank
