// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_work.hpp"

namespace flank
{
  /// The variants of a roller pair, one a piece. The axes must outlive the object.
  std::unique_ptr<StudyWork> roller_pair_study(const StudyAxes &axes);
} // namespace flank
