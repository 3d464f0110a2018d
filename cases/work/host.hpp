// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <unistd.h>

#include <cctype>
#include <string>

namespace flank
{
  /// The name of the machine that this process runs on, fit for a file's name; "unknown" where it has none.
  inline std::string host_name()
  {
    char name[256] = {};
    std::string host = gethostname(name, sizeof name - 1) == 0 && *name ? name : "unknown";
    for (char &c : host)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-')
        c = '_';
    return host;
  }
} // namespace flank
