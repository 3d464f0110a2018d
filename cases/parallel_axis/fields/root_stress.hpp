// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/fields/loaded_bodies.hpp"
#include "cases/parallel_axis/mesh_cycle.hpp"

namespace flank
{
  class ParallelSession;

  /// At the surface of a sector's two fillets under nodal displacements [mm] in the tooth's axes: [side][node along the face], greatest
  /// over the arc. Where cells meet along the face their values are averaged.
  std::array<std::vector<double>, 2> fillet_stress(const BodyElements &elements, const Eigen::VectorXd &displacement);

  /// Of all loaded teeth, both fillets, at all positions and torques. Complete on rank 0 only; collective. Throws ComputationError.
  std::vector<RootStress> root_stress(const ParallelAxisCase &input, LoadedBodies &bodies, const ParallelSession &session);
} // namespace flank
