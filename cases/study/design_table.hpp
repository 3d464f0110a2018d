// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flank
{
  /// Designs as a file lists them: keys, and points with a value for each.
  struct DesignTable
  {
    std::vector<std::string> keys;
    std::vector<std::vector<std::string>> points; ///< a value a key, as text
  };

  /// Told of the number of values of every design as it is read; throws where all become too many.
  using CountValues = std::function<void(std::size_t values)>;

  /// Reads a comma-separated file: keys in the first line, then a design a line. Messages show nothing of a
  /// file whose first line has no keys. `where` stands before messages. Throws InputError.
  DesignTable read_designs(const Schema &schema, const std::string &file, const std::string &where,
                           const CountValues &count);
} // namespace flank
