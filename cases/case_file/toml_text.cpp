// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/toml_text.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace flank
{
  namespace
  {
    /// Tables in tables in tables take stack when they go.
    void refuse_depth(const std::string &content, const std::string &where)
    {
      constexpr int most = 200;
      int chain = 0;
      for (const char c : content)
        if (c == '.')
          {
            if (++chain > most)
              throw InputError(fmt::format("{}: more than {} levels in one key", where, most));
          }
        else if (std::string_view("=,{}[]\n#").find(c) != std::string_view::npos)
          chain = 0;
    }

    /// Where the text or comment ends that begins at `at`; `at` itself where none does.
    std::size_t end_of_text(const std::string_view content, const std::size_t at)
    {
      const char c = content[at];
      if (c == '#')
        return std::min(content.find('\n', at), content.size());
      if (c != '"' && c != '\'')
        return at;
      const std::string thrice(3, c);
      const bool lines = content.substr(at).starts_with(thrice);
      for (std::size_t i = at + (lines ? 3 : 1); i < content.size(); ++i)
        {
          if (c == '"' && content[i] == '\\')
            ++i;
          else if (!lines && (content[i] == c || content[i] == '\n'))
            return i + 1;
          else if (lines && content.substr(i).starts_with(thrice)) // up to two more belong to the text
            return std::min({ content.size(), i + 5, content.find_first_not_of(c, i) });
        }
      return content.size();
    }

    /// The parser relies on it that outside of texts and comments there is plain ASCII alone.
    void refuse_letters(const std::string &content, const std::string &where)
    {
      for (std::size_t at = content.starts_with("\xEF\xBB\xBF") ? 3 : 0; at < content.size();)
        {
          const std::size_t end = end_of_text(content, at);
          if (end == at && static_cast<unsigned char>(content[at]) >= 0x80)
            throw InputError(fmt::format(
                "{}:{}: a letter that is no plain ASCII outside of texts in quotes and comments", where,
                1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(at), '\n')));
          at = std::max(end, at + 1);
        }
    }
  } // namespace

  void refuse_unparsable(const std::string &content, const std::string &where)
  {
    refuse_depth(content, where);
    refuse_letters(content, where);
  }

  std::string toml_text(const toml::node &node)
  {
    if (node.is_floating_point())
      return fmt::format("{}", node.as_floating_point()->get());
    if (node.is_integer() && node.as_integer()->flags() == toml::value_flags::none)
      return fmt::format("{}", node.as_integer()->get());
    if (node.is_string() && node.as_string()->get().find_first_of("\"\\\n") == std::string::npos)
      return "\"" + node.as_string()->get() + "\"";
    // The library's own way to write lists and tables counts columns by casting logarithms that can be
    // negative.
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
            const bool bare =
                !name.empty() && std::all_of(name.begin(), name.end(), [](const unsigned char c) {
                  return std::isalnum(c) || c == '_' || c == '-';
                });
            text += (text.empty() ? " " : ", ") + (bare ? name : toml_text(toml::value<std::string>(name))) +
                    " = " + toml_text(item);
          }
        return "{" + text + (text.empty() ? "}" : " }");
      }
    std::ostringstream stream;
    node.visit([&](const auto &value) { stream << value; });
    return stream.str();
  }

  double toml_number(const toml::node &node)
  {
    return node.is_integer() ? static_cast<double>(node.as_integer()->get())
                             : node.as_floating_point()->get();
  }
} // namespace flank
