// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// Flank's revision and build type and the libraries it was built with, one a line.
  std::string versions();

  /// Names the source code and the build that compute a body's operator, and the layout of its file.
  std::string operator_sources();

  /// Names all of the program's source code, and the build: what any result depends on.
  std::string program_sources();
} // namespace flank
