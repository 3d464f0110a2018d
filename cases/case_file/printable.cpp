// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/printable.hpp"

#include <algorithm>

namespace flank
{
  namespace
  {
    /// Bytes of the UTF-8 character that begins at a place; 0: none does.
    std::size_t length_at(const std::string &text, const std::size_t at)
    {
      const auto byte = [&](const std::size_t k) { return static_cast<unsigned char>(text[k]); };
      const unsigned first = byte(at);
      const std::size_t length = first < 0x80                    ? 1
                                 : first >= 0xc2 && first < 0xe0 ? 2
                                 : first >= 0xe0 && first < 0xf0 ? 3
                                 : first >= 0xf0 && first < 0xf5 ? 4
                                                                 : 0;
      if (length == 0 || at + length > text.size())
        return 0;
      for (std::size_t k = 1; k < length; ++k)
        if ((byte(at + k) & 0xc0) != 0x80)
          return 0;
      return length;
    }

    /// Marks that change the direction of the text after them: U+202A to U+202E, U+2066 to U+2069.
    bool turns_text(const std::string &character)
    {
      return (character >= "\xe2\x80\xaa" && character <= "\xe2\x80\xae") ||
             (character >= "\xe2\x81\xa6" && character <= "\xe2\x81\xa9");
    }
  } // namespace

  std::string printable(const std::string &text)
  {
    std::string result;
    for (std::size_t at = 0; at < text.size();)
      {
        const std::size_t length = length_at(text, at);
        const auto first = static_cast<unsigned char>(text[at]);
        const bool control = length == 1   ? (first < 0x20 && first != '\n' && first != '\t') || first == 0x7f
                             : length == 2 ? first == 0xc2 && static_cast<unsigned char>(text[at + 1]) < 0xa0
                                           : length == 3 && turns_text(text.substr(at, length));
        if (length == 0 || control)
          result += '?';
        else
          result.append(text, at, length);
        at += std::max<std::size_t>(1, length);
      }
    return result;
  }

  std::string printable_line(const std::string &text)
  {
    std::string line = printable(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line;
  }

  std::string shown_key(const std::string &path)
  {
    return path.size() > 80 ? path.substr(0, 80) + "... (" + std::to_string(path.size()) + " letters)" : path;
  }
} // namespace flank
