// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/extra.hpp"

namespace flank
{
  /// A case computed with all that it asks for.
  struct WholeRun
  {
    ParallelAxisResults results;
    std::vector<ExtraOutput> extras; ///< of rank 0, in the order of the case's
  };

  /// What the positions of a case keep for the extras that it asks for.
  Kept kept_for_extras(const ParallelAxisCase &input);

  /// Collective; complete on rank 0. What is too large to be handed back goes to the folder. Throws
  /// ComputationError.
  WholeRun run_with_extras(const ParallelAxisCase &input, const SharedWork &work, const ResultFolder &folder);
} // namespace flank
