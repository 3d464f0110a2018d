// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <csignal>
#include <iterator>

namespace flank
{
  /// While an object of this class lives, SIGINT, SIGTERM, SIGUSR1 (the one that mpirun hands on to its
  /// processes without ending them), SIGUSR2 and SIGXCPU (a limit of processor time comes near: batch systems
  /// send them) ask for a stop instead of ending the process. One at a time.
  class StopOnSignal
  {
  public:
    StopOnSignal();
    ~StopOnSignal(); ///< signals do what they did before
    StopOnSignal(const StopOnSignal &) = delete;

    /// Whether a signal has asked for a stop. Safe to call from any thread.
    bool is_asked() const;

  private:
    static constexpr int signals[] = { SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU };
    struct sigaction before_[std::size(signals)] = {};
  };
} // namespace flank
