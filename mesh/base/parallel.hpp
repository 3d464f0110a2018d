// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>

namespace flank
{
  /// Number of threads a stage may use: FLANK_THREADS if set, else the cores this process may run on.
  int available_threads();

  /// Calls work(i) for i = 0..count-1 on up to available_threads() threads. Which thread runs which i
  /// must not matter to the result. The exception of the lowest i that failed is thrown again after all have ended.
  void parallel_for(int count, const std::function<void(int)> &work);
} // namespace flank
