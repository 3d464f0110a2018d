// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/classical_split.hpp"
#include "cases/parallel_axis/projected_split.hpp"

#include <optional>

namespace flank
{
  enum class Split
  {
    projected, ///< finite elements plus half-space minus what the elements make of the half-space; no dial
    classical  ///< Vijayakar's: half-space relative to a point below the surface, finite elements at that point
  };

  /// One elastic body ready for contact: the far field of the finite elements joined to the near field of the half-space.
  class BodyCompliance
  {
  public:
    /// max_offset: teeth on either side whose response to a loaded tooth can be asked for.
    BodyCompliance(const Gear &gear, const SectorResolution &resolution, int max_offset, Split split, ClassicalDepth depth);

    /// Compliance between patches [mm/N], n x n, symmetrised; `asymmetry` receives max|C - C'| / max C before that.
    Eigen::MatrixXd between(const std::vector<Patch> &patches, double &asymmetry) const;

    const FlankCompliance &far_field() const { return far_field_; }
    int                    n_unknowns() const { return body_.n_unknowns(); }

  private:
    void add_far_field(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, Eigen::MatrixXd &c) const;

    Gear                          gear_;
    ClassicalDepth                depth_;
    ToothSector                   sector_;
    ElasticBody                   body_;
    FlankCompliance               far_field_;
    std::optional<ProjectedSplit> projected_; ///< empty: the classical split
  };
} // namespace flank
