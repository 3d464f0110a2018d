// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/extras/pressure_kind.hpp"
#include "cases/parallel_axis/pair/extra.hpp"
#include "contact/stress/side.hpp"

#include <functional>
#include <map>
#include <vector>

namespace flank
{
  /// What a coarser grid finds halfway between some positions of one torque, by its place among them, counted
  /// in steps.
  using Halves = std::map<double, PositionResult>;

  bool asks_for_root_stress(const ParallelAxisCase &input);

  /// The positions of the least and the greatest transmission error of a torque.
  std::vector<int> peaks_of_transmission_error(const ParallelAxisCase &input,
                                               const std::vector<PositionResult> &positions);

  /// The same, and of the greatest pressure where that has a limit.
  std::vector<int> peaks_of_contact(const ParallelAxisCase &input,
                                    const std::vector<PositionResult> &positions);

  /// The positions beside which more may hide at a torque, by its number: those of contact, and of the teeth
  /// that are bent most where root stress is asked for.
  std::vector<int> peaks_of(const FinishedRun &run, std::size_t torque);

  /// The halves next to some of the positions, which are so many, alone: bounds of one quantity do not depend
  /// on what was computed for another's.
  Halves beside(const std::vector<int> &peaks, const Halves &halves, std::size_t positions);

  /// The pressure of a position that is meant. [MPa]
  using PressureOf = std::function<double(const PositionResult &)>;

  /// How much of the greatest pressure may hide between the positions, relative, at least 0: as much again as
  /// halfway is seen, or 0.45 of how far curves reach beside the greatest that bend one way between
  /// known places; where nothing is known halfway beside it, no less than three eighths of what half as many
  /// positions miss. `of_cycle`:
  /// how many of them are a mesh cycle; `over_coarser`: the greatest pressure of a position over what the
  /// halves' coarser grid finds there.
  double hidden_pressure(const std::vector<PositionResult> &positions, int of_cycle, const Halves &halves,
                         double over_coarser, const PressureOf &pressure);

  /// The same of the greatest root stress of a body, which follows greatest_bending(): as much again as
  /// halfway is seen; where nothing is computed halfway beside it, as in a hunting period, no less than three
  /// eighths of what half as many positions miss.
  double hidden_root_stress(const GearPair &pair, const std::vector<PositionResult> &positions, int of_cycle,
                            const Halves &halves, Side side);

  /// pressure_kind(), where edges that carry more than the flanks inside do may touch halfway alone.
  PressureKind pressure_kind_with(const ParallelAxisCase &input, const std::vector<PositionResult> &positions,
                                  const Halves &halves);
} // namespace flank
