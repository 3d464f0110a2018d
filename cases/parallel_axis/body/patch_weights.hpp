// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/grid/patch.hpp"
#include "solver/elements/flank_surface.hpp"

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

  /// The patch clipped to every element and integrated there: exact for the elements' shape functions.
  PatchWeights patch_weights(const FlankSurface &surface, const Patch &patch);
} // namespace flank
