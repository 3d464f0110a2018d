// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/near_field.hpp"
#include "contact/matching/patch_group.hpp"
#include "solver/reduction/flank_compliance.hpp"

namespace flank
{
  /// How many planes of nodes below the flank flank_compliance() must answer for.
  int depth_planes(ClassicalDepth depth, int degree);

  /// What the elements make of a group's loads at the depths of the split, for PatchGroup::below.
  std::vector<Eigen::MatrixXd> responses_below(const FlankCompliance &far_field, ClassicalDepth depth,
                                               const PatchWeights &loads);

  /// Vijayakar's split (1991; Wagaj and Kahraman 2002, eq. 5) for groups on the same tooth, added to
  /// c(output, load) [mm/N]: u = u_s(i) - u_s(q) + u_fe(q), q below i. Not symmetric.
  void add_classical_split(const FlankCompliance &far_field, const Gear &gear, ClassicalDepth depth,
                           const PatchGroup &outputs, const PatchGroup &loads, Eigen::MatrixXd &c);
} // namespace flank
