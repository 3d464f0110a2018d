// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// One axis of a study: keys, and points with a value for each.
  struct StudyAxis
  {
    static constexpr long most_values = 4'000'000; ///< on all axes of a study

    std::string where; ///< file:line
    std::vector<std::string> keys;
    std::vector<std::vector<std::string>> points; ///< a value a key, as text
    bool is_range;                                ///< its values ascend or descend
    bool together_with_previous;                  ///< goes along with the axis before it
    std::string file;                             ///< that the axis is read from; empty: none
  };

  /// The [[study]] tables of a case, from its own text. Throws InputError.
  std::vector<StudyAxis> read_axes(const CaseFile &base);

  /// As much of a text as a line of a message holds.
  std::string shortened(const std::string &text);
} // namespace flank
