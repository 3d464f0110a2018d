// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/work/shared_work.hpp"
#include "contact/loaded/position_result.hpp"
#include "contact/stress/loaded_bodies.hpp"
#include "contact/stress/side.hpp"

#include <array>
#include <optional>
#include <vector>

namespace flank
{
  struct ParallelAxisCase;

  /// Greatest tensile stress in one fillet of one loaded tooth at one place of the face.
  struct RootStress
  {
    int torque, position; ///< numbers among the case's
    int body;             ///< 0 pinion, 1 gear
    int pair;             ///< tooth pair
    int other_side;       ///< 0: the fillet below the loaded flank, 1: the other one
    double z;             ///< user's z [mm]
    double stress;        ///< greatest principal stress over the fillet, tension positive [MPa]
  };

  /// Of every loaded tooth of both bodies at the positions of the first mesh cycle, whose cells are on every
  /// rank: on rank 0, by torque, position, body, pair, fillet and z. Collective. Throws ComputationError.
  std::vector<RootStress> root_stresses(const ParallelAxisCase &input, const PositionsOfTorques &at,
                                        LoadedBodies &bodies, const SharedWork &work);

  /// The greatest of each torque on the pinion and on the gear; null where there is none. `roots` outlive
  /// what is returned.
  std::vector<std::array<const RootStress *, 2>> greatest_of(const ParallelAxisCase &input,
                                                             const std::vector<RootStress> &roots);

  /// The loaded teeth of a body at a position that kept its cells, or the one of them in a tooth pair.
  struct LoadedTeethAt
  {
    const PositionResult *position;
    std::optional<int> pair = {};
  };

  /// The greatest tensile stress in both fillets of such teeth under the contact forces of the position, of
  /// each entry. [MPa] Throws ComputationError.
  std::vector<double> greatest_root_stresses(LoadedBodies &bodies, Side side,
                                             const std::vector<LoadedTeethAt> &of);
} // namespace flank
