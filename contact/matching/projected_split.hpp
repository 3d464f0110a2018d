// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/load_responses.hpp"
#include "contact/matching/near_field.hpp"
#include "contact/matching/patch_weights.hpp"
#include "contact/matching/source_table.hpp"
#include "mesh/base/parallel.hpp"

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

namespace flank
{
  /// Mean half-space potentials between the patches of two groups on one tooth, as one of the bodies sees
  /// them; both bodies need the same ones, in both directions. The second group may be the first. (patch of
  /// the first, of the second) [1/mm]
  Eigen::MatrixXd patch_potentials(const std::vector<Patch> &first, const std::vector<Patch> &second,
                                   const InvoluteHelicoid &flank);

  /// The bracket of the projected split, [(u_s)_ij - N_i W_j]: the half-space's answer less what the elements
  /// make of that same half-space on a small block (W_j: under f_j, with u_s on the block's cut and
  /// sigma(u_s).n on its true free faces). Outside the block it adds nothing.
  class ProjectedSplit
  {
  public:
    /// What a block is known by: first and last row, first and last layer of the loaded elements. Away from
    /// the face ends layers are shifted to those of the one block that stands for all (layer_shift()).
    using Key = std::tuple<int, int, int, int>;
    using Tables = std::map<Key, std::shared_ptr<const SourceTable>>;

    /// `tables`: those that are there already; `blocks` makes the blocks of the
    /// others when they are needed.
    /// `faces`: of the edges, if they are there already.
    ProjectedSplit(const Gear &gear, const FlankSurface &surface, const NearField &near_field,
                   std::function<const FlankBlocks &()> blocks, Tables tables = {},
                   const FlankEdges::Faces *faces = nullptr);

    /// Makes the tables of all single elements, which serve every patch that is no larger than an element, on
    /// some threads in the background. The object must stay until that is finished.
    std::unique_ptr<BackgroundWork> prepare(int threads);

    /// What a block of elements makes of the half-space under some of a group's patches, which lie on the
    /// same elements.
    struct Response
    {
      std::shared_ptr<const SourceTable> block;
      int shift;              ///< from these elements to the block's, in layers: layer_shift()
      std::vector<int> loads; ///< the patches that lie on these elements: their numbers in the group
      int first_node;         ///< node of the flank on which the block's first node lies
      LoadResponses moved;    ///< W of each of these patches, on the flank's nodes from first_node on [mm/N]
    };
    std::vector<Response> respond(const std::vector<Patch> &patches, const PatchWeights &weights) const;

    /// Whether any of the outputs lies on the block of any of the loads. Beyond the blocks the finite
    /// elements alone know better, and nothing is added.
    bool reaches(const PatchWeights &outputs, const std::vector<Response> &loads) const;

    /// EndMeans::between() or TipMeans::between() an output and a load.
    using MeansOfEdges = std::function<double(FlankEdge edge, std::size_t output, std::size_t load)>;

    /// Adds the bracket to c(output, load) [mm/N] for patches of one tooth. `responses`: of the loads;
    /// potential(output, load): patch_potentials().
    void add(const PatchWeights &outputs, const std::vector<Response> &responses,
             const Eigen::MatrixXd &potential, const MeansOfEdges &of_edges, Eigen::MatrixXd &c) const;

    const Tables &tables() const { return tables_; }
    const FlankEdges &edges() const { return edges_; }

  private:
    std::shared_ptr<const SourceTable> table(const Key &key) const;
    Key loaded_elements(const PatchWeights::Extent &extent) const;
    void add_point_forces(const Patch &patch, const PatchWeights::Extent &extent, int shift,
                          SourceTable::ColumnWeights &sources) const;
    Response respond_on(const Key &key, const std::vector<int> &loads, const std::vector<Patch> &patches,
                        const PatchWeights &weights) const;

    bool lies_on(const PatchWeights::Extent &patch, const Response &response) const
    {
      const SourceTable &block = *response.block;
      return patch.row_low >= block.first_row &&
             patch.row_high <= std::min(block.last_row + 1, surface_.rows) &&
             patch.layer_low >= block.first_layer - response.shift &&
             patch.layer_high <= block.last_layer + 1 - response.shift;
    }

    Gear gear_;
    InvoluteHelicoid helicoid_;
    FlankSurface surface_;
    int points_;
    FlankEdges edges_;
    double scale_; ///< compliance of the half-space times a potential [mm^2/N]
    std::function<const FlankBlocks &()> blocks_;

    mutable std::mutex mutex_;
    mutable Tables tables_;
  };
} // namespace flank
