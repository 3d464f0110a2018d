// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/parallel.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace flank
{
  namespace
  {
    std::atomic<int> processes_on_cores{ 1 };
  }

  void share_cores(const int processes)
  {
    processes_on_cores = std::max(1, processes);
  }

  int available_threads()
  {
    if (const char *text = std::getenv("FLANK_THREADS"))
      return std::clamp(std::atoi(text), 1, 256);
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof(set), &set) == 0)
      return std::max(1, CPU_COUNT(&set) / processes_on_cores);
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / processes_on_cores);
  }

  void parallel_for(const int count, const std::function<void(int)> &work)
  {
    std::atomic<int>   next{ 0 };
    std::mutex         mutex;
    int                failed_index = count;
    std::exception_ptr failure;

    const auto run = [&] {
      for (int i = next++; i < count; i = next++)
        try
          {
            work(i);
          }
        catch (...)
          {
            const std::lock_guard lock(mutex);
            if (i < failed_index)
              {
                failed_index = i;
                failure      = std::current_exception();
              }
          }
    };

    std::vector<std::thread> threads;
    for (int t = 1; t < std::min(available_threads(), count); ++t)
      threads.emplace_back(run);
    run();
    for (std::thread &thread : threads)
      thread.join();
    if (failure)
      std::rethrow_exception(failure);
  }
} // namespace flank
