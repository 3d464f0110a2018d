// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/report/make_report.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <filesystem>

#include <signal.h>
#include <unistd.h>

namespace flank
{
  void make_report(const std::string &folder)
  {
    const std::string script = FLANK_REPORT_SCRIPT;
    if (!std::filesystem::exists(script))
      throw InputError(fmt::format(
          "flank report: {} is not there; run `python3 cases/report/report.py {}` in the source tree", script,
          folder));
    // Python would end by a signal that comes before the script can take it: they wait until it says so.
    sigset_t stops;
    sigemptyset(&stops);
    for (const int stop : { SIGINT, SIGTERM, SIGHUP })
      sigaddset(&stops, stop);
    sigprocmask(SIG_BLOCK, &stops, nullptr);
    for (const char *python : { "/usr/bin/python3", "python3" })
      execlp(python, python, "-E", "-s", script.c_str(), folder.c_str(), static_cast<char *>(nullptr));
    throw InputError("flank report: no python3; on Debian: apt-get install python3-matplotlib");
  }
} // namespace flank
