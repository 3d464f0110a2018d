// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "cases/parallel_axis/pair/stated_errors.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/study/study_work.hpp"
#include "cases/work/result_folder.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flank
{
  class Journal;

  /// Whether a study's case asks for the error estimates of all variants.
  bool asks_for_every_estimate(const StudyAxes &axes);

  /// What stands before the names of a variant's records in the study's journal; empty for the first variant,
  /// whose names are those of a run.
  std::string before_names_of(long variant);

  /// Adds error_estimates.csv and bounds for designs.csv: the error estimates of all variants but those that
  /// failed, whose positions the journal holds; nothing where all failed. `groups`: variants of equal bodies.
  /// One process alone, on all its threads. Throws ComputationError.
  void add_estimates_of_variants(const StudyAxes &axes, const std::vector<std::vector<long>> &groups,
                                 const std::function<bool(long)> &has_failed, Journal &journal,
                                 const ResultFolder &folder, BeyondTables &result);

  /// Time that the error estimate of one variant takes when the bodies are there. [s]
  double seconds_of_estimate(const ParallelAxisCase &input);
} // namespace flank
