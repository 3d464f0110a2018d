// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/body/classical_split.hpp"
#include "cases/parallel_axis/body/projected_split.hpp"
#include "solver/reduction/flank_compliance.hpp"

namespace flank
{
  /// One elastic body ready for contact: the far field of the finite elements joined to the near field of the half-space.
  class BodyCompliance
  {
  public:
    /// max_offset: teeth on either side whose response to a loaded tooth can be asked for.
    /// Distributed reduction: collective over the ranks of `session`; on ranks other than 0 the object stays empty.
    BodyCompliance(const Gear &gear, const SectorResolution &resolution, int max_offset, const NearField &near_field = {},
                   const BodyModel &model = {}, const ParallelSession *session = nullptr, StageClock *clock = nullptr);

    /// From what such a body was reduced to before. Elements are made only if a patch larger than an element asks for them.
    BodyCompliance(const Gear &gear, const SectorResolution &resolution, const NearField &near_field, FlankCompliance far_field,
                   int n_unknowns, ProjectedSplit::Tables tables);

    /// Adds the compliance between patches to c [mm/N], n x n: not exactly symmetric. `potentials`: of the same patches as any
    /// body of the pair sees them.
    void add(const std::vector<Patch> &patches, PatchPotentials &potentials, Eigen::MatrixXd &c) const;

    const FlankCompliance &far_field() const { return far_field_; }
    const ProjectedSplit  *projected() const { return projected_.get(); } ///< null: the classical split
    int                    n_unknowns() const { return n_unknowns_; }

  private:
    void add_far_field(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, Eigen::MatrixXd &c) const;

    Gear                            gear_;
    NearField                       near_field_;
    std::unique_ptr<BodyElements>   elements_;
    FlankCompliance                 far_field_;
    int                             n_unknowns_;
    std::unique_ptr<ProjectedSplit> projected_; ///< empty: the classical split
  };

  /// Replaces c by its symmetric part; returns max|c - c'| / max|c| before.
  double symmetrise(Eigen::MatrixXd &c);
} // namespace flank
