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

  /// Memory of a direct factor of so many unknowns of elements of a degree: measured, degrees 2 and 3.
  /// [bytes]
  double factor_bytes(double unknowns, int degree);

  /// Memory of FilletStress, which is that of both blocks' factors. [bytes]
  double fillets_bytes(const SectorResolution &resolution);

  /// What the body's size makes of an automatic reduction: all ranks together where one process would take
  /// more than half of its node's memory.
  BodyModel::Reduction reduction_of(const BodyModel &model, const SectorResolution &resolution, int ranks);
} // namespace flank
