// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"
#include "cases/case_file/toml_text.hpp"

#include <string>
#include <variant>
#include <vector>

namespace flank
{
  /// What a key is given.
  using Value = std::variant<std::string, long, double, std::vector<double>, std::vector<std::string>>;

  /// A key's value checked against its type, bounds and choices. `place`: "file:line: key", for messages.
  /// Throws InputError.
  Value value_of(const Key &key, const toml::node &node, const std::string &place);

  /// As much of a value as a line of a message bears.
  std::string shown_value(const toml::node &node);
} // namespace flank
