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
      texts,
      integer,
      number,
      numbers
    };
    std::string              path; ///< dotted, e.g. "pinion.tip_relief.amount_um"; "pinion.bias[].corner" for tables in a list
    Type                     type;
    double                   low, high; ///< inclusive bounds of numbers; low_open: low itself is not allowed
    bool                     low_open;
    std::string              fallback;      ///< default as text; "required"; or what happens when left out
    std::string              meaning;       ///< with unit
    std::vector<std::string> choices;       ///< of text and texts
    std::string              scene;         ///< that it belongs to; empty: every one
    bool                     listed = true; ///< false: a twin of a listed key (the other gear, one flank alone)

    std::string allowed() const; ///< in words, for messages and the table
  };

  const std::vector<Key> &schema();

  /// The key of a path as a case gives it, such as "pinion.bias[2].corner"; null if there is none.
  const Key *find_key(const std::string &path);

  /// Such a path as the schema spells it: "pinion.bias[].corner". Tables in a list are numbered from 1 to 99 at most; what is numbered
  /// otherwise stays as it is, and no key.
  std::string schema_path(const std::string &path);

  /// Table for `flank schema`, or Markdown for cases/README.md.
  std::string schema_text(bool markdown);

  /// The known key nearest to a wrong one by edit distance; of one scene, if given.
  std::string nearest_key(const std::string &path, const std::string &scene = "");
} // namespace flank
