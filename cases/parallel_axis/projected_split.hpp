// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/patch_weights.hpp"
#include "solver/flank_block.hpp"

namespace flank
{
  /// The bracket of the projected split, [(u_s)_ij - N_i W_j]: the half-space's answer less what the elements make of that
  /// same half-space on a small block (W_j: under f_j, with u_s on the block's cut and sigma(u_s).n on its true free faces).
  /// Nothing outside the block. No dial.
  class ProjectedSplit
  {
  public:
    /// Keeps references to both.
    ProjectedSplit(const ToothSector &sector, const ElasticBody &body);

    /// Adds the bracket of every pair of patches on the same tooth to c [mm/N].
    void add(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, Eigen::MatrixXd &c) const;

  private:
    /// A unit force on a patch as the half-space sees it.
    struct HalfSpaceSource
    {
      double                       half_profile, half_generator; ///< [mm]
      Eigen::Vector3d              origin;
      Eigen::Matrix3d              axes;                     ///< columns: profile, generator, inward
      std::vector<Eigen::Vector4d> points;                   ///< x, y, 0, force: the same patch as point loads, for distant places
      Eigen::Vector3d local(const Eigen::Vector3d &x) const; ///< z no less than 0: points of a curved flank lie above its tangent plane
    };
    HalfSpaceSource source(const Patch &patch, int layer_shift) const;

    /// W_j on the block's flank nodes. [mm]
    Eigen::VectorXd block_response(const Patch &patch, const PatchWeights &weights, const FlankBlock &block, int layer_shift) const;

    /// Nodal forces of sigma(u_s).n on the block's true free faces. [N]
    Eigen::VectorXd free_face_forces(const HalfSpaceSource &source, const FlankBlock &block) const;

    const ToothSector &sector_;
    double             youngs_modulus_, poissons_ratio_;
    InvoluteHelicoid   helicoid_;
    FlankSurface       surface_;
    FlankBlocks        blocks_;
  };
} // namespace flank
