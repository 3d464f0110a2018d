// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_axes.hpp"

#include <string>

namespace flank
{
  constexpr std::size_t variants_a_piece = 24; ///< of a study, that share a position's compliance

  /// Contact stage of one more variant in a piece, over that of the first: what `validation/run plan` prints,
  /// of variants whose gaps alone differ.
  constexpr double another_variant = 0.30;

  /// The plan of a study without a look at every variant: bodies by what changes them on each axis alone.
  /// table_bytes: of all variants.
  std::string plan_by_axes(const StudyAxes &axes, int processes, double table_bytes);
} // namespace flank
