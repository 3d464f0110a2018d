// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_work.hpp"

namespace flank
{
  /// The variants of a double-roller case, each a piece. The axes must outlive the object.
  std::unique_ptr<StudyWork> double_roller_study(const StudyAxes &axes);
} // namespace flank
