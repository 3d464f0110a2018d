// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/stop_on_signal.hpp"

namespace flank
{
  namespace
  {
    volatile std::sig_atomic_t stop_asked = 0;
  } // namespace

  StopOnSignal::StopOnSignal()
  {
    struct sigaction action = {};
    action.sa_handler = [](int) { stop_asked = 1; };
    for (std::size_t k = 0; k < std::size(signals); ++k)
      sigaction(signals[k], &action, &before_[k]);
  }

  StopOnSignal::~StopOnSignal()
  {
    for (std::size_t k = 0; k < std::size(signals); ++k)
      sigaction(signals[k], &before_[k], nullptr);
  }

  bool StopOnSignal::is_asked() const
  {
    return stop_asked != 0;
  }
} // namespace flank
