// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/files/checked_file.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace flank
{
  /// A table that goes to the disk line by line.
  class TableFile
  {
  public:
    explicit TableFile(const std::string &path)
        : file_(path)
    {
    }
    template <class... Values>
    void print(fmt::format_string<Values...> format, Values &&...values)
    {
      file_.write(fmt::format(format, std::forward<Values>(values)...));
    }
    TableFile &operator<<(const std::string_view text)
    {
      file_.write(text);
      return *this;
    }
    void finish() { file_.finish(); }

  private:
    CheckedFile file_;
  };
} // namespace flank
