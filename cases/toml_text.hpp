// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <toml++/toml.h>

namespace flank
{
  /// A value as TOML writes it: numbers in the shortest form that reads back, texts in double quotes.
  std::string toml_text(const toml::node &node);
} // namespace flank
