// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"

namespace flank
{
  void assertion_failed(const char *condition, const char *file, int line, const std::string &numbers)
  {
    throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": internal error, not true: " +
                           condition + (numbers.empty() ? "" : " (" + numbers + ")"));
  }
} // namespace flank
