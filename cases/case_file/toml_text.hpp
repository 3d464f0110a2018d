// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

// The parser takes for granted, where it begins a key, that one begins there ("[!]"), and then looks: what it
// finds it refuses in words, unless the assertion ends the program before or the compiler relies on it.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace flank
{
  /// Throws InputError for what the parser must not be given: keys of too many levels, letters beyond ASCII
  /// outside of texts and comments. `where`: file or setting, the message's beginning.
  void refuse_unparsable(const std::string &content, const std::string &where);

  /// A value as TOML writes it: numbers in the shortest form that reads back, texts in double quotes.
  std::string toml_text(const toml::node &node);

  /// The value of a number; an integer that no double holds is rounded.
  double toml_number(const toml::node &node);
} // namespace flank
