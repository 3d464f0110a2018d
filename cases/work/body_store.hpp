// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/operator_cache.hpp"
#include "contact/matching/body_compliance.hpp"
#include "contact/matching/body_definition.hpp"

namespace flank
{
  class ParallelSession;

  /// Size of an operator, about. [GB]
  double operator_gigabytes(const BodyDefinition &request);

  /// Names everything the operator depends on: the body, and the source code and libraries that compute it.
  std::string operator_key(const BodyDefinition &request);

  /// The bodies that are asked for, each from the cache, else reduced now and stored there. The ranks of
  /// `session` (may be null: one) take the bodies in turn, or all together one whose reduction is
  /// distributed; every rank receives all of them. The clock tells what this rank did. Where `failure` is
  /// given, a body that cannot be computed throws nothing: every rank is told so, and gets none.
  std::vector<std::shared_ptr<const BodyCompliance>> reduced_bodies(std::vector<BodyDefinition> requests,
                                                                    const OperatorCache &cache,
                                                                    const ParallelSession *session,
                                                                    StageClock &clock,
                                                                    std::string *failure = nullptr);
} // namespace flank
