// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "contact/loaded/stress_below_contact.hpp"

#include <memory>

namespace flank
{
  /// The free edges of a pair's flanks; null where the case has half-spaces there.
  inline std::shared_ptr<const EdgesOfPair> free_edges_of(const ParallelAxisCase &input)
  {
    const bool are_free = input.near_field.split == Split::projected && input.near_field.free_ends;
    return are_free ? std::make_shared<const EdgesOfPair>(input.pair) : nullptr;
  }
} // namespace flank
