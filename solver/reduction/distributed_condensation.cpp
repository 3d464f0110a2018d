// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/distributed_condensation.hpp"

#include "solver/libraries/element_libraries.hpp"
#include "solver/parallel_session.hpp"

namespace flank
{
  Eigen::MatrixXd condense_distributed(const ElasticBody &body, const NodeAxes &axes,
                                       const std::vector<char> &fixed, const std::vector<int> &kept,
                                       const ParallelSession &session)
  {
    return element_libraries().condense_across_ranks(
        body, axes, fixed, kept, session.rank(), session.ranks(),
        [&](double *values, const std::ptrdiff_t count) { session.add_to_root(values, count); });
  }
} // namespace flank
