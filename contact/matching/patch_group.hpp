// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/projected_split.hpp"

namespace flank
{
  /// Some patches of one tooth with what a body makes of unit loads on them; two such groups then couple at
  /// little cost.
  struct PatchGroup
  {
    int tooth;
    std::vector<Patch> patches;
    PatchWeights weights;
    std::vector<int> nodes = {};                     ///< nodes of the flank that any patch touches
    LoadResponses on_nodes = {};                     ///< the weights on these nodes
    std::vector<ProjectedSplit::Response> near = {}; ///< projected split: W of blocks of elements
    std::vector<Eigen::MatrixXd> below = {}; ///< classical split: of the elements at every depth; a row a
                                             ///< flank node, a column a load [mm/N]
  };
} // namespace flank
