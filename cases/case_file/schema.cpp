// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/schema.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  namespace
  {
    constexpr double unbounded = 1e300; ///< bounds from here on are not said
  }

  namespace keys
  {
    Key text(std::string path, std::string fallback, std::string meaning, std::vector<std::string> choices)
    {
      return { .path = std::move(path),
               .type = Key::Type::text,
               .fallback = std::move(fallback),
               .meaning = std::move(meaning),
               .choices = std::move(choices) };
    }

    Key texts(std::string path, std::string fallback, std::string meaning, std::vector<std::string> choices)
    {
      Key key = text(std::move(path), std::move(fallback), std::move(meaning), std::move(choices));
      key.type = Key::Type::texts;
      return key;
    }

    Key number(std::string path, const double low, const double high, std::string fallback,
               std::string meaning, const bool low_open)
    {
      return { .path = std::move(path),
               .type = Key::Type::number,
               .low = low,
               .high = high,
               .low_open = low_open,
               .fallback = std::move(fallback),
               .meaning = std::move(meaning) };
    }

    Key numbers(std::string path, const double low, const double high, std::string fallback,
                std::string meaning)
    {
      Key key = number(std::move(path), low, high, std::move(fallback), std::move(meaning));
      key.type = Key::Type::numbers;
      return key;
    }

    Key integer(std::string path, const double low, const double high, std::string fallback,
                std::string meaning)
    {
      Key key = number(std::move(path), low, high, std::move(fallback), std::move(meaning));
      key.type = Key::Type::integer;
      return key;
    }
  } // namespace keys

  namespace
  {
    std::size_t edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<std::size_t> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0);
      for (std::size_t i = 1; i <= a.size(); ++i)
        {
          std::size_t diagonal = row[0];
          row[0] = i;
          for (std::size_t j = 1; j <= b.size(); ++j)
            {
              const std::size_t above = row[j];
              row[j] = std::min({ row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1]) });
              diagonal = above;
            }
        }
      return row.back();
    }
  } // namespace

  Schema::Schema(const std::vector<SceneKeys> &scenes)
  {
    std::vector<std::string> names;
    for (const SceneKeys &own : scenes)
      names.push_back(own.scene);
    keys_ = { keys::text("title", "", "shown in every result"),
              keys::text("scene", "required", "kind of drive", names) };
    for (const SceneKeys &own : scenes)
      {
        for (Key key : own.keys)
          {
            key.scene = own.scene;
            keys_.push_back(std::move(key));
          }
        copy_.insert(copy_.end(), own.copy.begin(), own.copy.end());
        notes_ += own.note.empty() ? "" : own.note + "\n";
      }
    for (std::size_t k = 0; k < keys_.size(); ++k)
      {
        const bool is_new = by_path_.emplace(keys_[k].path, k).second;
        FLANK_ASSERT(is_new,
                     keys_[k].path); // two scenes need two names: a key's bounds and meaning are those of one
      }
  }

  std::string Key::allowed() const
  {
    switch (type)
      {
      case Type::text:
        return choices.empty() ? "a text without control characters"
                               : "\"" + fmt::format("{}", fmt::join(choices, "\" or \"")) + "\"";
      case Type::texts:
        return "a list of \"" + fmt::format("{}", fmt::join(choices, "\", \"")) + "\"";
      case Type::integer:
        return fmt::format("an integer from {:g} to {:g}", low, high);
      default:
        return fmt::format("{} {} {:g}{}", type == Type::numbers ? "a list of numbers" : "a number",
                           low_open ? "greater than" : "from", low,
                           high < unbounded ? fmt::format(" {} {:g}", low_open ? "and up to" : "to", high)
                                            : "");
      }
  }

  std::string Schema::spelled(const std::string &path)
  {
    std::string result;
    for (std::size_t at = 0; at < path.size();)
      {
        const auto open = path.find('[', at), close = path.find(']', std::min(open, path.size()));
        if (close == std::string::npos)
          return result + path.substr(at);
        const std::string number = path.substr(open + 1, close - open - 1);
        const bool numbers =
            !number.empty() && number.size() <= 2 && number.front() != '0' &&
            std::all_of(number.begin(), number.end(), [](const char c) { return c >= '0' && c <= '9'; });
        result += path.substr(at, open - at) + (numbers ? "[]" : path.substr(open, close + 1 - open));
        at = close + 1;
      }
    return result;
  }

  const Key *Schema::find(const std::string &path) const
  {
    const auto it = by_path_.find(path.find('[') == std::string::npos ? path : spelled(path));
    return it == by_path_.end() ? nullptr : &keys_[it->second];
  }

  bool Schema::leads(const std::string &start) const
  {
    const auto it = by_path_.lower_bound(start);
    return it != by_path_.end() && it->first.starts_with(start);
  }

  std::string Schema::text(const bool markdown) const
  {
    std::string result = notes_;
    if (markdown)
      result += "\n| key | scene | allowed | when left out | meaning |\n|---|---|---|---|---|\n";
    for (const Key &key : keys_)
      if (key.listed)
        result += markdown ? fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path,
                                         key.scene.empty() ? "all" : key.scene, key.allowed(), key.fallback,
                                         key.meaning)
                           : fmt::format("{}\n    {}{}\n    allowed: {}\n    when left out: {}\n", key.path,
                                         key.scene.empty() ? "" : "[" + key.scene + "] ", key.meaning,
                                         key.allowed(), key.fallback.empty() ? "empty" : key.fallback);
    return result;
  }

  std::string Schema::nearest(const std::string &path, const std::string &scene) const
  {
    // An index that is none is not far from one.
    const std::string bare =
        path.substr(0, path.find('[')) +
        (path.find('[') == std::string::npos ? ""
                                             : "[]" + path.substr(std::min(path.size(), path.find(']') + 1)));
    const auto distance = [&](const Key &key) {
      return scene.empty() || key.scene.empty() || key.scene == scene ? edit_distance(key.path, bare)
                                                                      : std::string::npos;
    };
    const Key *nearest = nullptr;
    std::size_t least = std::string::npos;
    for (const Key &key : keys_)
      if (const std::size_t own = distance(key); !nearest || own < least)
        nearest = &key, least = own;
    return nearest->path;
  }
} // namespace flank
