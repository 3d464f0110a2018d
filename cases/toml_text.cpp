// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace flank
{
  std::string toml_text(const toml::node &node)
  {
    if (node.is_floating_point())
      return fmt::format("{}", node.as_floating_point()->get());
    if (node.is_string() && node.as_string()->get().find_first_of("\"\\\n") == std::string::npos)
      return "\"" + node.as_string()->get() + "\"";
    // The library's own way to write lists and tables counts columns by casting logarithms that can be negative.
    if (const toml::array *list = node.as_array())
      {
        std::string text;
        for (const toml::node &item : *list)
          text += (text.empty() ? " " : ", ") + toml_text(item);
        return "[" + text + (text.empty() ? "]" : " ]");
      }
    if (const toml::table *table = node.as_table())
      {
        std::string text;
        for (const auto &[key, item] : *table)
          {
            const std::string name(key.str());
            const bool        bare = !name.empty() && std::all_of(name.begin(), name.end(),
                                                                  [](const unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
            text += (text.empty() ? " " : ", ") + (bare ? name : toml_text(toml::value<std::string>(name))) + " = " + toml_text(item);
          }
        return "{" + text + (text.empty() ? "}" : " }");
      }
    std::ostringstream stream;
    node.visit([&](const auto &value) { stream << value; });
    return stream.str();
  }

  double toml_number(const toml::node &node)
  {
    return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  }
} // namespace flank
