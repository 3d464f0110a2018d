// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// The noun for so many things: "key" for 1, else "keys". `several`: where it is not `one` and an s.
  inline std::string noun_for(const double count, const std::string &one, const std::string &several = {})
  {
    return count == 1 ? one : several.empty() ? one + "s" : several;
  }

  /// A whole number of things: "1 key", "3 keys".
  template <class Count>
  std::string counted(const Count count, const std::string &one, const std::string &several = {})
  {
    return std::to_string(count) + " " + noun_for(static_cast<double>(count), one, several);
  }
} // namespace flank
