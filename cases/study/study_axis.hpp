// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/case_file/toml_text.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// One axis of a study: keys, and points with a value for each.
  struct StudyAxis
  {
    static constexpr const char *allowed =
        "allowed are set with values, rows or from, to, count, spacing; or file; and together_with_previous";
    static constexpr long most_values = 4'000'000; ///< on all axes of a study

    std::string where; ///< file:line
    std::vector<std::string> keys;
    std::vector<std::vector<std::string>> points; ///< a value a key, as text
    bool is_range;                                ///< its values ascend or descend
    std::string file;                             ///< that it is read from; empty: none
  };

  /// From one [[study]] table of a case. `n_values`: on all axes up to here, counted on. Throws InputError.
  StudyAxis read_axis(const CaseFile &base, const toml::table &table, const std::string &where,
                      double &n_values);

  /// The beginning of messages about a node of the case's [[study]].
  std::string place_of_study(const CaseFile &base, const toml::node &node);

  /// For messages: no more of a text than a line holds.
  std::string shown_of_study(const std::string &text);
} // namespace flank
