// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/csv_cell.hpp"

#include "cases/case_file/printable.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace flank
{
  namespace
  {
    /// Whether a spreadsheet may take a text for a formula: it begins as one, in letters of any width, behind
    /// whatever a reader does not see.
    bool is_like_a_formula(std::string_view text)
    {
      const auto skip = [&](const std::string_view letter) {
        const bool is_next = text.starts_with(letter);
        if (is_next)
          text.remove_prefix(letter.size());
        return is_next;
      };
      constexpr std::array<std::string_view, 21> blank = { " ",      "\t",     "\r",     "\n",     "\u00a0",
                                                           "\u2000", "\u2001", "\u2002", "\u2003", "\u2004",
                                                           "\u2005", "\u2006", "\u2007", "\u2008", "\u2009",
                                                           "\u200a", "\u200b", "\u2028", "\u2029", "\u3000",
                                                           "\ufeff" };
      while (std::ranges::any_of(blank, skip))
        ;
      constexpr std::array<std::string_view, 9> starts = { "=",      "+",      "-",      "@",     "\uff1d",
                                                           "\uff0b", "\uff0d", "\uff20", "\u2212" };
      return std::ranges::any_of(starts,
                                 [&](const std::string_view start) { return text.starts_with(start); });
    }
  } // namespace

  std::string csv_cell(std::string text)
  {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
      text = text.substr(1, text.size() - 2);
    text = printable(text);
    char *end = nullptr;
    const bool is_number = !text.empty() && (std::strtod(text.c_str(), &end), *end == '\0');
    if (!is_number && (is_like_a_formula(text) || text.starts_with('\t')))
      text.insert(0, "'");
    if (text.find_first_of(",\"\n") == std::string::npos)
      return text;
    std::string result = "\"";
    for (const char c : text)
      result += c == '"' ? "\"\"" : std::string(1, c == '\n' ? ' ' : c);
    return result + "\"";
  }
} // namespace flank
