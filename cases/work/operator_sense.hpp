// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/body_definition.hpp"
#include "contact/matching/projected_split.hpp"
#include "solver/reduction/flank_compliance.hpp"

namespace flank
{
  /// Throws UnusableRecord, with what is wrong, unless it holds.
  void require(bool holds, const char *wrong);

  /// Checks that what was stored can be the operator of such a body: sizes that fit each other and the
  /// request, finite numbers, a flank that yields to its own load. Throws UnusableRecord where it cannot.
  void require_sense(const BodyDefinition &request, const FlankCompliance &far, int n_unknowns);

  /// Checks that a table is that of a block around loaded elements: it reaches beyond them, where the flank
  /// does. Throws UnusableRecord where it is not.
  void require_sense(const SectorResolution &mesh, const ProjectedSplit::Key &loaded,
                     const SourceTable &table);

  /// Checks that values can be those of the face of a wedge. Throws UnusableRecord where they cannot.
  void require_face(const Eigen::Ref<const Eigen::MatrixXd> &displacements,
                    const Eigen::Ref<const Eigen::MatrixXd> &integrals);

  /// Checks that a table is of a part of the body: a block that is held at its cut yields less than the body
  /// it is a part of, and less under sources than the body does under a force. Throws UnusableRecord where it
  /// is not.
  void require_part_of(const FlankCompliance &far, const SourceTable &table);
} // namespace flank
