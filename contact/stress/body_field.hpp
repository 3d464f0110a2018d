// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_result.hpp"
#include "contact/matching/body_compliance.hpp"
#include "contact/stress/contact_region.hpp"
#include "contact/stress/side.hpp"
#include "solver/elements/field_piece.hpp"
#include "solver/fields/loaded_teeth.hpp"

namespace flank
{
  /// Nodal forces on a body's flanks under the contact's forces [N]: the same consistent loads as in the
  /// body's compliance.
  TeethLoads flank_loads(const FlankSurface &surface, const PositionResult &result, Side side);

  /// The arrays that body_field() gives, with their units.
  std::vector<FieldPiece::Array> body_arrays(bool with_displacement, bool with_stress);

  /// One tooth's part of a field, in its own axes.
  struct ToothField
  {
    int tooth;
    Eigen::VectorXd displacement; ///< of the sector's nodes [mm]
    Eigen::VectorXd
        without_contact; ///< of the contact region's nodes [mm]; empty where the tooth carries no load
    const NearLoads *contact = nullptr; ///< of a loaded tooth
  };

  /// Displacement [mm] and stress [MPa] of some teeth, in place at a mesh position: of the finite elements,
  /// joined by the half-space's (or a wedge's, at free edges) in the contact region of loaded teeth, whose
  /// loaded elements are shown in finer cells.
  FieldPiece body_field(const BodyElements &elements, const ContactRegion &region, const Placement &placement,
                        Side side, const std::vector<ToothField> &teeth, bool with_displacement,
                        bool with_stress);

  /// The contact's cells on both flanks, in place at a mesh position.
  FieldPiece contact_field(const GearPair &pair, const PositionResult &result);
} // namespace flank
