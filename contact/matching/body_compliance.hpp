// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/classical_split.hpp"
#include "contact/matching/projected_split.hpp"
#include "contact/matching/tip_means.hpp"
#include "solver/reduction/flank_compliance.hpp"

namespace flank
{
  /// One elastic body ready for contact: the far field of the finite elements joined to the near field of the
  /// half-space.
  class BodyCompliance
  {
  public:
    /// max_offset: teeth on either side whose response to a loaded tooth can be asked for.
    /// Distributed reduction: collective over the ranks of `session`; on ranks other than 0 the object stays
    /// empty.
    BodyCompliance(const Gear &gear, const SectorResolution &resolution, int max_offset,
                   const NearField &near_field = {}, const BodyModel &model = {},
                   const ParallelSession *session = nullptr, StageClock *clock = nullptr);

    /// Made from an operator that was reduced before. Elements are made only if a patch larger than an
    /// element asks for them. `faces`: of both ends of the flank, where there are some.
    BodyCompliance(const Gear &gear, const SectorResolution &resolution, const NearField &near_field,
                   FlankCompliance far_field, int n_unknowns, ProjectedSplit::Tables tables,
                   const FlankEdges::Faces *faces);

    PatchGroup group(std::vector<Patch> patches) const;

    /// Adds the elements' part of the compliance, which is symmetric, to c[group](load, output) [mm/N]:
    /// displacements of the patches of some groups, all of one tooth, under loads. (Classical split: nothing
    /// on the loaded tooth, which it answers below the surface.)
    void add_far(const PatchGroup &loads, const std::vector<const PatchGroup *> &outputs,
                 const std::vector<Eigen::MatrixXd *> &c) const;

    /// Whether the half-space adds anything between two groups.
    bool is_near(const PatchGroup &first, const PatchGroup &second) const;

    /// Adds the half-space's part of the compliance, which is not exactly symmetric: to forth(first, second)
    /// the displacements of the first group under loads on the second, to back(second, first) the other way
    /// round [mm/N]; null: not asked for, as of a group and itself, where both are the same.
    /// potential(first, second): patch_potentials(), as any body of the pair sees the two groups. `strips`:
    /// kept from call to call of this body.
    void add_near(const PatchGroup &first, const PatchGroup &second, const Eigen::MatrixXd &potential,
                  Eigen::MatrixXd &forth, Eigen::MatrixXd *back, TipStrips &strips) const;

    /// The same of two groups alone.
    void add_near(const PatchGroup &first, const PatchGroup &second, const Eigen::MatrixXd &potential,
                  Eigen::MatrixXd &forth, Eigen::MatrixXd *back) const
    {
      TipStrips strips;
      add_near(first, second, potential, forth, back, strips);
    }

    const BodyElements &elements() const { return *elements_; }
    const FlankCompliance &far_field() const { return far_field_; }
    const ProjectedSplit *projected() const { return projected_.get(); } ///< null: the classical split
    int n_unknowns() const { return n_unknowns_; }

  private:
    Gear gear_;
    NearField near_field_;
    std::unique_ptr<BodyElements> elements_;
    FlankCompliance far_field_;
    int n_unknowns_;
    std::unique_ptr<ProjectedSplit> projected_; ///< empty: the classical split
  };
} // namespace flank
