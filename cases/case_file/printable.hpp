// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// A text that a terminal shows as it is: control characters, which could move the cursor or write
  /// elsewhere, become "?"; so does what is no UTF-8. Ends of lines and tabs stay.
  std::string printable(const std::string &text);

  /// A printable text on one line.
  std::string printable_line(const std::string &text);

  /// As much of a key or a path as a message bears.
  std::string shown_key(const std::string &path);
} // namespace flank
