// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank
{
  /// The exit code of a command that was stopped by a signal.
  constexpr int stopped_by_signal = 4;

  /// Makes this process fit to compute, whatever it was started with: standard streams that are closed lead
  /// nowhere, signals end it with a word and exit code 4, memory of contact grids is kept for the next one.
  /// A study starts the program once more for that, with large pages.
  void set_up_process(int argc, char **argv);

  /// Takes what the system's limits allow of open files and stack. Throws std::system_error with the limit
  /// where that is too little.
  void require_limits();

  /// Whether standard output was closed when the program was started.
  bool output_was_closed();
} // namespace flank
