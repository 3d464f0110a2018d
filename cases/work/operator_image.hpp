// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/body_compliance.hpp"
#include "contact/matching/body_definition.hpp"

namespace flank
{
  /// An operator as bytes, which are kept in the cache and sent to other ranks.
  std::vector<char> pack_operator(const BodyCompliance &body);

  /// The operator that stored bytes are, ready for use. Nothing in the bytes is trusted; throws
  /// UnusableRecord where they cannot be the operator of such a body.
  std::shared_ptr<const BodyCompliance> unpack_operator(const BodyDefinition &request, SharedBytes payload);
} // namespace flank
