// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace flank
{
  /// One key of the case file. Parsing, bounds, `flank schema` and the key table of cases/README.md all come
  /// from these.
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
    /// Name with its tables, dotted: "pinion.tip_relief.amount_um"; "pinion.bias[].corner" for tables in a
    /// list.
    std::string path;
    Type type = Type::text;
    double low = 0;  ///< least number allowed; not itself where low_open says so
    double high = 0; ///< greatest number allowed
    bool low_open = false;
    std::string fallback = {};             ///< default as text; "required"; or what happens when left out
    std::string meaning = {};              ///< what the value says, with its unit
    std::vector<std::string> choices = {}; ///< values allowed of a text, or of each of several texts
    std::string scene = {};                ///< name of the scene whose key it is; empty: a key of every scene
    bool listed = true; ///< false: a twin of a listed key (the other gear, one flank alone)

    /// Type, bounds and choices in words, for messages and the table of keys.
    std::string allowed() const;
  };

  /// Functions that make a key of each type; scenes declare their keys with them, one call a key.
  namespace keys
  {
    Key text(std::string path, std::string fallback, std::string meaning,
             std::vector<std::string> choices = {});
    Key texts(std::string path, std::string fallback, std::string meaning, std::vector<std::string> choices);
    Key number(std::string path, double low, double high, std::string fallback, std::string meaning,
               bool low_open = false);
    Key numbers(std::string path, double low, double high, std::string fallback, std::string meaning);
    Key integer(std::string path, double low, double high, std::string fallback, std::string meaning);
  } // namespace keys

  /// A key that, where a case gives it, fills in what is left out of one group of keys from another group.
  struct CopyRule
  {
    std::string key;      ///< such as "gear.like"
    std::string from, to; ///< beginnings of the keys of both groups, such as "pinion." and "gear."

    /// Beginnings of the keys that say what a key of `to` says in another way, belong to one list with it, or
    /// say it of more: where the case gives one of them, that key is not copied.
    std::function<std::vector<std::string>(const std::string &path)> rivals;

    /// Two keys of `to` that say the same thing: a given one replaces the copy of the other.
    std::vector<std::pair<std::string, std::string>> same = {};
  };

  /// The keys of one kind of drive.
  struct SceneKeys
  {
    std::string scene; ///< value of the key `scene`
    std::vector<Key> keys;
    std::vector<CopyRule> copy = {};
    std::string note = {}; ///< text above the table of keys: about keys that it does not list
  };

  /// All keys that a case can have: those of every scene, and the title and the choice of the scene itself.
  class Schema
  {
  public:
    explicit Schema(const std::vector<SceneKeys> &scenes);

    const std::vector<Key> &keys() const { return keys_; }
    const std::vector<CopyRule> &copy_rules() const { return copy_; }

    /// The key of a path as a case gives it, such as "pinion.bias[2].corner"; null if there is none.
    const Key *find(const std::string &path) const;

    /// Whether any key begins so, such as "pinion.bias[].".
    bool leads(const std::string &start) const;

    /// The known key nearest to a wrong one by edit distance; of one scene, if given.
    std::string nearest(const std::string &path, const std::string &scene = "") const;

    /// All keys as `flank schema` prints them, or as the table in Markdown of cases/README.md.
    std::string text(bool markdown) const;

    /// A path as a case gives it in the spelling of the keys: "pinion.bias[].corner". Tables in a list are
    /// numbered from 1 to 99 at most; what is numbered otherwise stays as it is, and no key.
    static std::string spelled(const std::string &path);

  private:
    std::vector<Key> keys_;
    std::map<std::string, std::size_t> by_path_;
    std::vector<CopyRule> copy_;
    std::string notes_;
  };
} // namespace flank
