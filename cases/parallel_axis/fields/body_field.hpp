// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/body/body_compliance.hpp"
#include "cases/parallel_axis/loaded_mesh.hpp"
#include "contact/grid/placement.hpp"
#include "solver/fields/loaded_teeth.hpp"
#include "solver/fields/vtu_file.hpp"

namespace flank
{
  enum class Side
  {
    pinion,
    gear
  };

  inline Placement placement_of(const GearPair &pair, const Side side, const double phase)
  {
    return side == Side::pinion ? pinion_placement(pair, phase) : gear_placement(pair, phase);
  }

  /// Nodal forces on a body's flanks under the contact's forces: the same consistent loads that its operator was asked about.
  TeethLoads flank_loads(const FlankSurface &surface, const PositionResult &result, Side side);

  /// What body_field() gives.
  std::vector<FieldPiece::Array> body_arrays(bool with_displacement, bool with_stress);

  /// Displacement [mm] and stress [MPa] of the finite elements of some teeth, in place at a mesh position. displacement: a tooth each, in
  /// the tooth's own axes.
  FieldPiece body_field(const BodyElements &elements, const Placement &placement, Side side, const std::vector<int> &teeth,
                        const std::vector<Eigen::VectorXd> &displacement, bool with_displacement, bool with_stress);

  /// The contact's cells on both flanks, in place at a mesh position.
  FieldPiece contact_field(const GearPair &pair, const PositionResult &result);
} // namespace flank
