// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_axes.hpp"

#include <string>

namespace flank
{
  constexpr std::size_t variants_a_piece = 24; ///< of a study: they share a position's compliance

  /// Time of the contact stage for one more variant of a piece, over that for the first, where gaps alone
  /// differ. `validation/run plan` prints it.
  constexpr double another_variant = 0.23;

  /// The plan of a study without a look at every variant: bodies by what changes them on each axis alone.
  /// table_bytes: of all variants.
  std::string plan_by_axes(const StudyAxes &axes, int processes, double table_bytes);
} // namespace flank
