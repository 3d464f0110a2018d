// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/grid/patch.hpp"
#include "solver/elements/flank_surface.hpp"

#include <span>

namespace flank
{
  /// A patch as the flank's elements see it: the consistent nodal forces f_j of a unit force spread evenly over it, which
  /// is also the functional N_i that reads its mean displacement.
  struct PatchWeights
  {
    std::vector<int>    row_node, layer_node;                     ///< flank nodes it touches
    std::vector<int>    node;                                     ///< the same by FlankSurface::node()
    std::vector<double> value;                                    ///< of those nodes; sums to 1
    double              row_low, row_high, layer_low, layer_high; ///< extent in element coordinates
  };

  /// The weights of several patches one after the other, where they are read most.
  class PackedWeights
  {
  public:
    PackedWeights() = default;
    explicit PackedWeights(const std::vector<PatchWeights> &patches);

    std::span<const int>    nodes(const std::size_t patch) const { return { &node_[begin_[patch]], begin_[patch + 1] - begin_[patch] }; }
    std::span<const double> values(const std::size_t patch) const { return { &value_[begin_[patch]], begin_[patch + 1] - begin_[patch] }; }

  private:
    std::vector<std::size_t> begin_{ 0 };
    std::vector<int>         node_;
    std::vector<double>      value_;
  };

  /// The patch clipped to every element and integrated there: exact for the elements' shape functions.
  PatchWeights patch_weights(const FlankSurface &surface, const Patch &patch);
} // namespace flank
