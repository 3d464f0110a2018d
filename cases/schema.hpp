// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <vector>

namespace flank
{
  /// One key of the case file. Parsing, bounds, `flank schema` and the key table of cases/README.md all come from these.
  struct Key
  {
    enum class Type
    {
      text,
      integer,
      number,
      numbers
    };
    std::string              path; ///< dotted, e.g. "pinion.tip_relief.amount_um"
    Type                     type;
    double                   low, high; ///< inclusive bounds of numbers; low_open: low itself is not allowed
    bool                     low_open;
    std::string              fallback; ///< default as text; "required"; or what happens when left out
    std::string              meaning;  ///< with unit
    std::vector<std::string> choices;  ///< of texts
    std::string              scene;    ///< that it belongs to; empty: every one

    std::string allowed() const; ///< in words, for messages and the table
  };

  const std::vector<Key> &schema();

  /// Table for `flank schema`, or Markdown for cases/README.md.
  std::string schema_text(bool markdown);

  /// The known key nearest to a wrong one by edit distance; of one scene, if given.
  std::string nearest_key(const std::string &path, const std::string &scene = "");
} // namespace flank
