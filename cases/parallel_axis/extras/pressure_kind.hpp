// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "contact/loaded/position_result.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// Whether the greatest pressure has a limit as cells shrink, and if not, why.
  enum class PressureKind
  {
    regular,
    kink, ///< it is where a flank's slope jumps
    edge  ///< tips, cut cells and face ends carry more than the flanks inside do
  };

  /// Names of the kinds in tables, in the order of PressureKind.
  const std::vector<std::string> &pressure_kinds();

  /// The kind of the greatest pressure of one torque over a mesh cycle, whose positions are given.
  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions);

  /// The greatest pressure of a position over the slices without a kink of a flank or an edge in or beside
  /// them, which has a limit as cells shrink; 0: there is none. [MPa]
  double regular_pressure(const ParallelAxisCase &input, const PositionResult &position);
} // namespace flank
