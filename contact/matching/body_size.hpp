// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/reduction/flank_compliance.hpp"

namespace flank
{
  /// How large one tooth sector's condensation is.
  struct BodySize
  {
    double unknowns; ///< of the elements
    double cut;      ///< unknowns on both cuts
    double flank;    ///< nodes on the loaded flank

    double kept() const { return cut + flank; } ///< unknowns of the Schur complement
    double gigabytes() const; ///< at the peak of the condensation: measured from draft to reference meshes
  };

  BodySize size_of(const SectorResolution &resolution);

  /// Memory of FilletStress, with the factors of both blocks.
  double fillets_gigabytes(const SectorResolution &resolution);

  /// What the body's size makes of an automatic reduction: all ranks together where one process would take
  /// more than half of its node's memory.
  BodyModel::Reduction reduction_of(const BodyModel &model, const SectorResolution &resolution, int ranks);
} // namespace flank
