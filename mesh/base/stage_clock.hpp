// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace flank
{
  /// Wall times of stages that follow each other.
  class StageClock
  {
  public:
    /// Ends a stage that began where the last one ended.
    void finished(const std::string &stage)
    {
      const auto now = std::chrono::steady_clock::now();
      stages_.emplace_back(part + stage, std::chrono::duration<double>(now - mark_).count());
      mark_ = now;
    }

    const std::vector<std::pair<std::string, double>> &stages() const
    {
      return stages_;
    } ///< names and seconds

    std::string part; ///< put before the names of the stages: what they belong to

  private:
    std::chrono::steady_clock::time_point mark_ = std::chrono::steady_clock::now();
    std::vector<std::pair<std::string, double>> stages_;
  };
} // namespace flank
