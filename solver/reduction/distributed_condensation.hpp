// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/elastic_body.hpp"

#include <vector>

namespace flank
{
  class ParallelSession;

  /// The Schur complement that condense() gives, of the body's stiffness in `axes`, computed by all ranks
  /// together: METIS shares the cells out, every rank assembles its own, MUMPS factors across the ranks, and
  /// the Schur complement comes from solutions for blocks of right sides. For bodies whose factor does not
  /// fit one process. Collective; rank 0 receives the complement, the others an empty matrix. [N/mm]
  Eigen::MatrixXd condense_distributed(const ElasticBody &body, const NodeAxes &axes,
                                       const std::vector<char> &fixed, const std::vector<int> &kept,
                                       const ParallelSession &session);
} // namespace flank
