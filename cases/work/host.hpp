// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <unistd.h>

#include <string>

namespace flank
{
  /// The name of the machine that this process runs on; "unknown" where it has none.
  inline std::string host_name()
  {
    char name[256] = {};
    return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
  }
} // namespace flank
