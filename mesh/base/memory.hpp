// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// What a process may still take, and who says so.
  struct MemoryLimit
  {
    double bytes;
    std::string by; ///< in words
  };

  /// The least of what the machine has free, the control groups of this process leave, and its own limits
  /// (ulimit -v, -d). Address space is counted apart from memory: a program of several libraries and threads
  /// reserves more than it uses. `processes`: how many processes on this machine share its memory and the
  /// control groups; limits of a process are each one's own.
  MemoryLimit available_memory(int processes = 1);

  /// What this machine has, used or not. [bytes]
  double machine_memory();

  /// Throws InputError with the figures and `remedy` if `what` needs more than there is. `bytes`: what each
  /// of the `processes` on this machine needs.
  void require_memory(double bytes, int processes, const std::string &what, const std::string &remedy);
} // namespace flank
