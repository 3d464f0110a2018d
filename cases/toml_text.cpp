// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/toml_text.hpp"

#include <fmt/format.h>

#include <sstream>

namespace flank
{
  std::string toml_text(const toml::node &node)
  {
    if (node.is_floating_point())
      return fmt::format("{}", node.as_floating_point()->get());
    if (node.is_string() && node.as_string()->get().find_first_of("\"\\\n") == std::string::npos)
      return "\"" + node.as_string()->get() + "\"";
    std::ostringstream stream;
    node.visit([&](const auto &value) { stream << value; });
    return stream.str();
  }

  double toml_number(const toml::node &node)
  {
    return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  }
} // namespace flank
