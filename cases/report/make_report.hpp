// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// `flank report`: gives the process over to report.py, which lies beside this file; Debian's interpreter
  /// first, which has the libraries. Throws InputError where that cannot be started.
  [[noreturn]] void make_report(const std::string &folder);
} // namespace flank
