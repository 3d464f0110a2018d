// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/parallel.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <system_error>

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
      {
        constexpr int most = 256;
        int threads = 0;
        const char *end = text + std::strlen(text), *read = std::from_chars(text, end, threads).ptr;
        if (read != end || threads < 1 || threads > most)
          throw InputError(
              fmt::format("FLANK_THREADS = {:.40}: threads of a process, allowed is an integer from 1 to {}",
                          text, most));
        return threads;
      }
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof(set), &set) == 0)
      return std::max(1, CPU_COUNT(&set) / processes_on_cores);
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / processes_on_cores);
  }

  int machine_cores()
  {
    return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  }

  BackgroundWork::BackgroundWork(const int count, std::function<void(int)> work, const int threads)
      : count_(count)
      , work_(std::move(work))
      , failed_index_(count)
  {
    try
      {
        for (int t = 0; t < std::min(threads, count); ++t)
          threads_.emplace_back([this] { run(); });
      }
    catch (const std::system_error &)
      {
        // No more threads to be had: those that there are, and who helps, do it.
      }
  }

  BackgroundWork::~BackgroundWork()
  {
    next_ = count_;
  }

  void BackgroundWork::run()
  {
    for (int i = next_++; i < count_; i = next_++)
      try
        {
          work_(i);
        }
      catch (...)
        {
          const std::lock_guard lock(mutex_);
          if (i < failed_index_)
            {
              failed_index_ = i;
              failure_ = std::current_exception();
            }
        }
  }

  void BackgroundWork::finish()
  {
    run();
    threads_.clear(); // joins
    if (failure_)
      std::rethrow_exception(failure_);
  }

  void parallel_for(const int count, const std::function<void(int)> &work)
  {
    BackgroundWork(count, work, std::min(available_threads(), count) - 1).finish();
  }
} // namespace flank
