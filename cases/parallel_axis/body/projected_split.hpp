// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/body/patch_weights.hpp"
#include "cases/parallel_axis/body/source_table.hpp"
#include "mesh/base/parallel.hpp"

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

namespace flank
{
  /// Mean half-space potentials between patches of one tooth [1/mm]: both bodies need the same ones, so each is computed once.
  /// For one thread.
  class PatchPotentials
  {
  public:
    /// The patches as one of the bodies sees them; kept by reference.
    PatchPotentials(const std::vector<Patch> &patches, const InvoluteHelicoid &flank);
    PatchPotentials(const PatchPotentials &) = delete;

    /// Of two patches of one tooth.
    double operator()(std::size_t i, std::size_t j);

  private:
    const std::vector<Patch>      &patches_;
    InvoluteHelicoid               flank_;
    std::vector<int>               place_;    ///< of a patch among those of its tooth
    std::map<int, Eigen::MatrixXd> of_tooth_; ///< negative: not yet
    std::vector<Eigen::MatrixXd *> own_;      ///< of each patch's tooth
  };

  /// The bracket of the projected split, [(u_s)_ij - N_i W_j]: the half-space's answer less what the elements make of that
  /// same half-space on a small block (W_j: under f_j, with u_s on the block's cut and sigma(u_s).n on its true free faces).
  /// Nothing outside the block.
  class ProjectedSplit
  {
  public:
    /// First and last row, first and last layer of the loaded elements (layers shifted to where one block stands for all).
    using Key    = std::tuple<int, int, int, int>;
    using Tables = std::map<Key, std::shared_ptr<const SourceTable>>;

    /// `points`: NearField::points. `tables`: those known already; `blocks` is asked for the others.
    ProjectedSplit(const Gear &gear, const FlankSurface &surface, int points, std::function<const FlankBlocks &()> blocks,
                   Tables tables = {});

    /// Makes the tables of all single elements, which serve every patch that is no larger than an element, on some threads in the
    /// background. The object must stay until that is finished.
    std::unique_ptr<BackgroundWork> prepare(int threads);

    /// Adds the bracket of every pair of patches on the same tooth to c [mm/N]. Safe to use from several threads.
    void add(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, PatchPotentials &potentials,
             Eigen::MatrixXd &c) const;

    const Tables &tables() const { return tables_; }

  private:
    std::shared_ptr<const SourceTable> table(const Key &key) const;

    Gear                                 gear_;
    InvoluteHelicoid                     helicoid_;
    FlankSurface                         surface_;
    int                                  points_;
    std::function<const FlankBlocks &()> blocks_;

    mutable std::mutex mutex_;
    mutable Tables     tables_;
  };
} // namespace flank
