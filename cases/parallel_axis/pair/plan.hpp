// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/cost.hpp"

#include <string>

namespace flank
{
  /// What will be computed, what is left out and why, time and memory: the report of `flank plan`. Computes
  /// nothing else.
  std::string plan_report(const ParallelAxisCase &input, int processes);

  /// The line by which a run says what it will take.
  std::string plan_line(const ParallelAxisCase &input, const CostEstimate &cost);
} // namespace flank
