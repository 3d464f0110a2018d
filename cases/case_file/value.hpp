// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"
#include "cases/case_file/toml_text.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace flank
{
  /// The value that a case gives a key.
  using Value = std::variant<std::string, long, double, std::vector<double>, std::vector<std::string>>;

  /// A key's value checked against its type, bounds and choices. `place`: "file:line: key", for messages.
  /// Throws InputError.
  Value value_of(const Key &key, const toml::node &node, const std::string &place);

  /// Whether value_of() takes what a text says for a key, as one sees at a glance: plain numbers within its
  /// bounds, one of its choices, a text of plain letters. False: only value_of() can tell.
  bool is_plainly_allowed(const Key &key, std::string_view text);

  /// The number that all of a text is; nothing if it is none.
  std::optional<double> number_in(std::string_view text);

  /// As much of a value as a line of a message bears, control characters as "?".
  std::string shown_value(const toml::node &node);
} // namespace flank
