// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/operator_cache.hpp"
#include "cases/parallel_axis/body/body_compliance.hpp"

namespace flank
{
  class ParallelSession;

  /// How a body is to be reduced: everything besides the gear that its operator depends on.
  struct BodyRequest
  {
    Gear             gear;
    SectorResolution resolution;
    BodyModel        model;
    int              max_offset;
    Split            split;
    ClassicalDepth   depth;
  };

  /// Names everything the operator depends on: gear, mesh, split, and the source code and libraries that compute it.
  std::string operator_key(const BodyRequest &request);

  /// From the cache, else reduced now and stored there. Under several ranks (session may be null: one) rank 0 does this, or all
  /// together where the reduction is distributed, and the others receive the operator. The clock tells what was done.
  std::shared_ptr<const BodyCompliance> reduced_body(BodyRequest request, const OperatorCache &cache, const ParallelSession *session,
                                                     StageClock &clock);
} // namespace flank
