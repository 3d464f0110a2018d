// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>

namespace flank
{
  /// Number of threads a stage may use: FLANK_THREADS if set, else this process's share of the cores it may run on.
  int available_threads();

  /// How many processes share those cores (1 unless said).
  void share_cores(int processes);

  /// Calls work(i) for i = 0..count-1 on up to available_threads() threads. Which thread runs which i
  /// must not matter to the result. The exception of the lowest i that failed is thrown again after all have ended.
  void parallel_for(int count, const std::function<void(int)> &work);
} // namespace flank
