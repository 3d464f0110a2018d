// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace flank
{
  /// Number of threads a stage may use: FLANK_THREADS if set, else this process's share of the cores it may
  /// run on.
  int available_threads();

  /// Cores of the machine, whatever this process is bound to.
  int machine_cores();

  /// Tells available_threads() how many processes share the cores that this process may run on. Without a
  /// call: one.
  void share_cores(int processes);

  /// work(i) for i = 0..count-1, done by some threads in the background and by whoever helps. Which thread
  /// does which i must not matter to the result.
  class BackgroundWork
  {
  public:
    BackgroundWork(int count, std::function<void(int)> work, int threads);
    ~BackgroundWork(); ///< begins nothing more, waits for what is under way
    BackgroundWork(const BackgroundWork &) = delete;

    /// Helps until all is done. The exception of the lowest i that failed is thrown again.
    void finish();

  private:
    void run();

    int count_;
    std::function<void(int)> work_;
    std::atomic<int> next_{ 0 };
    std::mutex mutex_;
    int failed_index_;
    std::exception_ptr failure_;
    std::vector<std::jthread> threads_; ///< last: joined before the rest is gone
  };

  /// work(i) for i = 0..count-1 on up to available_threads() threads; returns when all are done.
  void parallel_for(int count, const std::function<void(int)> &work);
} // namespace flank
