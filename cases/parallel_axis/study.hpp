// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_work.hpp"

namespace flank
{
  /// The variants of a parallel-axis case, grouped by their bodies: one reduction a distinct body, whatever
  /// else the variants change. The axes must outlive the object.
  std::unique_ptr<StudyWork> parallel_axis_study(const StudyAxes &axes);
} // namespace flank
