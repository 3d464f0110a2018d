// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/case_file.hpp"

#include "cases/case_file/toml_text.hpp"
#include "cases/work/checked_file.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>

namespace flank
{
  namespace
  {
    /// As much of a value as a line of a message bears.
    std::string shown_value(const toml::node &node)
    {
      const std::string text = toml_text(node);
      return text.size() > 80 ? text.substr(0, 80) + "..." : text;
    }

    std::string shown_key(const std::string &path)
    {
      return path.size() > 80 ? fmt::format("{}... ({} letters)", path.substr(0, 80), path.size()) : path;
    }

    /// What the parser says, without what it quotes of the file.
    std::string reason(const toml::parse_error &error)
    {
      const std::string_view text  = error.description();
      const auto             quote = text.find_first_of("'\"");
      return std::string(text.substr(0, quote)) + (quote == std::string_view::npos ? "" : "...");
    }
  } // namespace

  void CaseFile::add_text(const std::string &content, const std::string &name,
                          const std::string &setting_where)
  {
    const bool  is_setting = !setting_where.empty();
    toml::table root;
    refuse_unparsable(content, is_setting ? setting_where + " " + shown_key(name) : name);
    try
      {
        root = toml::parse(std::string_view(content), std::string_view(name));
      }
    catch (const toml::parse_error &error)
      {
        throw InputError(
            is_setting
                ? fmt::format("{} {}: not valid: {}", setting_where, shown_key(name), reason(error))
                : fmt::format("{}:{}: not valid TOML: {}", name, error.source().begin.line, reason(error)));
      }
    if (!is_setting && !root["scene"].is_string())
      throw InputError(fmt::format("{}: scene: missing; needed is {}: {}", name,
                                   schema_->find("scene")->allowed(), schema_->find("scene")->meaning));

    const std::function<void(const toml::table &, const std::string &)> visit =
        [&](const toml::table &table, const std::string &prefix) {
          for (const auto &[name_view, node] : table)
            {
              const std::string path = prefix + std::string(name_view.str());
              if (path == "study" && !is_setting)
                {
                  has_study_ = true;
                  continue;
                }
              const std::string where =
                  is_setting ? setting_where : fmt::format("{}:{}", file_, node.source().begin.line);
              if (path.size() > most_key_letters)
                throw InputError(fmt::format("{}: {}: unknown key; none has more than {} letters", where,
                                             shown_key(path), most_key_letters));
              const Key        *key     = schema_->find(path);
              const std::string general = Schema::spelled(path);
              const auto        leads   = [&](const std::string &start) {
                return std::any_of(schema_->keys().begin(), schema_->keys().end(),
                                            [&](const Key &k) { return k.path.starts_with(start); });
              };
              const bool group = leads(general + "."), list = leads(general + "[].");
              if (const toml::array *array = node.as_array(); list && array)
                {
                  std::erase_if(entries_,
                                [&](const auto &entry) { return entry.first.starts_with(path + "["); });
                  if (array->size() > most_tables)
                    throw InputError(fmt::format("{}: {}: {} tables, at most {} are allowed", where, path,
                                                 array->size(), most_tables));
                  if (array->empty()) // says "none", where `like` would copy some
                    entries_[path + "[]"] = { {}, "[]", where };
                  int index = 0;
                  for (const toml::node &item : *array)
                    {
                      ++index;
                      if (!item.is_table())
                        throw InputError(fmt::format("{}: {}[{}] = {}: must be a table of keys such as {}",
                                                     where, path, index, shown_value(item),
                                                     schema_->nearest(general + "[].")));
                      if (item.as_table()->empty())
                        throw InputError(
                            fmt::format("{}: {}[{}] is empty: must be a table of keys such as {}", where,
                                        path, index, schema_->nearest(general + "[].")));
                      visit(*item.as_table(), fmt::format("{}[{}].", path, index));
                    }
                  continue;
                }
              if (list)
                throw InputError(fmt::format(
                    "{}: {}: must be a list of tables: {} = [ {{ ... }}, {{ ... }} ]", where, path, path));
              if (!key)
                {
                  if (group && node.is_table())
                    {
                      visit(*node.as_table(), path + ".");
                      continue;
                    }
                  if (group)
                    throw InputError(fmt::format("{}: {} = {}: must be a table of keys such as {}", where,
                                                 path, shown_value(node), schema_->nearest(path)));
                  throw InputError(fmt::format(
                      "{}: unknown key {}{}; the nearest known key is {} (all keys: flank schema)", where,
                      path, node.is_table() ? "" : " = " + shown_value(node), schema_->nearest(path)));
                }
              Entry      entry{ {}, toml_text(node), where };
              const auto refuse = [&, &node = node](const std::string &what) {
                throw InputError(fmt::format("{}: {} = {}: {}, allowed is {}", where, path, shown_value(node),
                                             what, key->allowed()));
              };
              const auto bounded = [&](const toml::array &list) {
                if (list.size() > most_numbers)
                  refuse(fmt::format("{} entries, at most {} are read", list.size(), most_numbers));
              };
              const auto check = [&](const double value) {
                if (!std::isfinite(value))
                  refuse("not a finite number");
                if (value < key->low || value > key->high || (key->low_open && value == key->low))
                  refuse("out of bounds");
                return value;
              };
              switch (key->type)
                {
                case Key::Type::text:
                  {
                    if (!node.is_string())
                      refuse("not a text");
                    const std::string value = node.as_string()->get();
                    if (value.size() > most_letters)
                      refuse(fmt::format("{} letters, at most {} are read", value.size(), most_letters));
                    if (value.find('\0') != std::string::npos)
                      refuse("holds a zero");
                    if (!key->choices.empty() &&
                        std::find(key->choices.begin(), key->choices.end(), value) == key->choices.end())
                      refuse("unknown choice");
                    entry.value = value;
                    break;
                  }
                case Key::Type::texts:
                  {
                    const toml::array       *array = node.as_array();
                    std::vector<std::string> values;
                    if (!array)
                      refuse("not a list of texts");
                    bounded(*array);
                    for (const toml::node &item : *array)
                      {
                        if (!item.is_string() || std::find(key->choices.begin(), key->choices.end(),
                                                           item.as_string()->get()) == key->choices.end())
                          refuse("unknown choice");
                        values.push_back(item.as_string()->get());
                      }
                    entry.value = values;
                    break;
                  }
                case Key::Type::integer:
                  if (!node.is_integer())
                    refuse("not an integer");
                  check(static_cast<double>(node.as_integer()->get()));
                  entry.value = static_cast<long>(node.as_integer()->get());
                  break;
                case Key::Type::number:
                  if (!node.is_number())
                    refuse("not a number");
                  entry.value = check(toml_number(node));
                  break;
                case Key::Type::numbers:
                  {
                    std::vector<double> values;
                    if (node.is_number())
                      values.push_back(check(toml_number(node)));
                    else if (const toml::array *array = node.as_array())
                      {
                        bounded(*array);
                        for (const toml::node &item : *array)
                          {
                            if (!item.is_number())
                              refuse("not a list of numbers");
                            values.push_back(check(toml_number(item)));
                          }
                      }
                    else
                      refuse("not a list of numbers");
                    if (values.empty())
                      refuse("an empty list");
                    entry.value = values;
                  }
                }
              entries_[path] = std::move(entry);
            }
        };
    visit(root, "");
  }

  CaseFile CaseFile::read(const Schema &schema, const std::string &file,
                          const std::vector<std::string> &settings)
  {
    std::string content;
    try
      {
        content = content_of(file, most_bytes);
      }
    catch (const std::runtime_error &error)
      {
        throw InputError(fmt::format("{}: {}; give the path of a case file (ready ones are cases/*/*.toml)",
                                     shown_key(file), error.what()));
      }
    return of_text(schema, std::move(content), file, settings);
  }

  CaseFile CaseFile::of_text(const Schema &schema, std::string content, const std::string &file,
                             const std::vector<std::string> &settings)
  {
    CaseFile result(schema);
    result.file_   = file;
    result.source_ = std::move(content);
    result.add_text(result.source_, file);
    for (const std::string &setting : settings)
      result.add_setting(setting, "--set");
    result.finish();
    return result;
  }

  CaseFile CaseFile::with(const std::vector<std::string> &settings, const std::string &where) const
  {
    CaseFile result = *this;
    result.entries_ = given_;
    for (const std::string &setting : settings)
      result.add_setting(setting, where);
    result.finish();
    return result;
  }

  void CaseFile::check(const std::vector<std::string> &settings, const std::string &where) const
  {
    CaseFile file(*schema_);
    for (const std::string &setting : settings)
      file.add_setting(setting, where);
  }

  void CaseFile::add_setting(const std::string &setting, const std::string &where)
  {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(fmt::format("{} {}: must be key=value", where, shown_key(setting)));
    if (setting.size() > most_setting_bytes)
      throw InputError(
          fmt::format("{} {}: at most {} letters are read", where, shown_key(setting), most_setting_bytes));
    const std::string path = setting.substr(0, equals), value = setting.substr(equals + 1);
    if (path.size() > most_key_letters)
      throw InputError(fmt::format("{} {}: unknown key; none has more than {} letters", where,
                                   shown_key(path), most_key_letters));
    const auto letter = [](const char c) {
      return std::isalnum(static_cast<unsigned char>(c)) ||
             std::string_view("_.[]").find(c) != std::string_view::npos;
    };
    if (!std::all_of(path.begin(), path.end(), letter))
      throw InputError(fmt::format("{} {}: no key has such a name; keys are made of letters, digits, _ and "
                                   "dots (all keys: flank schema)",
                                   where, shown_key(path)));
    const Key *key = schema_->find(path);
    if (const auto bracket = path.find('[');
        !key && bracket != std::string::npos &&
        schema_->nearest(path).starts_with(path.substr(0, bracket) + "[]"))
      throw InputError(
          fmt::format("{} {}: unknown key; the tables of {} are numbered from 1 to {}, such as {}[1]", where,
                      shown_key(path), path.substr(0, bracket), most_tables, path.substr(0, bracket)));
    const bool bare =
        key && key->type == Key::Type::text && !value.starts_with('"') && !value.starts_with('\'');
    // A numbered table of a list is a name of its own to TOML.
    std::string        quoted;
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, '.');)
      quoted +=
          (quoted.empty() ? "" : ".") + (part.find('[') == std::string::npos ? part : "\"" + part + "\"");
    add_text(quoted + " = " + (bare ? "\"" + value + "\"" : value), setting, where);
  }

  void CaseFile::finish()
  {
    given_ = entries_;
    for (const CopyRule &rule : schema_->copy_rules())
      if (has(rule.key))
        {
          text(rule.key); // it is used
          copy(rule);
        }
    const Key *scene_key = schema_->find("scene");
    if (!has("scene"))
      throw InputError(fmt::format("{}: scene: missing; needed is {}: {}", file_, scene_key->allowed(),
                                   scene_key->meaning));
    const std::string scene = text("scene");
    for (const auto &[path, entry] : entries_)
      if (const Key *key = schema_->find(path); key && !key->scene.empty() && key->scene != scene)
        throw InputError(
            fmt::format("{}belongs to scene = \"{}\", this case is \"{}\"; the nearest key of its own is {}",
                        place(path), key->scene, scene, schema_->nearest(path, scene)));
    for (const Key &key : schema_->keys())
      if (key.fallback == "required" && key.path.find('[') == std::string::npos &&
          (key.scene.empty() || key.scene == scene) && !has(key.path))
        throw InputError(
            fmt::format("{}: {}: missing; needed is {}: {}", file_, key.path, key.allowed(), key.meaning));
  }

  void CaseFile::copy(const CopyRule &rule)
  {
    const auto given = entries_;
    for (const auto &[path, entry] : given)
      if (path.starts_with(rule.from))
        {
          const std::string own = rule.to + path.substr(rule.from.size()), rival = rule.rivals(own);
          if (std::none_of(given.begin(), given.end(),
                           [&](const auto &g) { return g.first.starts_with(rival); }))
            entries_.emplace(own, entry).first->second.copied = true;
        }
    for (const auto &[one, other] : rule.same)
      if (given.contains(one) != given.contains(other))
        entries_.erase(given.contains(one) ? other : one);
  }

  bool CaseFile::has_any(const std::string &prefix) const
  {
    const auto it = entries_.lower_bound(prefix);
    return it != entries_.end() && it->first.starts_with(prefix);
  }

  std::vector<std::string> CaseFile::keys_ending_with(const std::string &end) const
  {
    std::vector<std::string> result;
    for (const auto &[path, entry] : entries_)
      if (path.ends_with(end))
        result.push_back(path);
    return result;
  }

  std::string CaseFile::text_of_file(const std::string &path) const
  {
    const std::string name = (std::filesystem::path(file_).parent_path() / text(path)).string();
    try
      {
        return content_of(name, most_table_bytes);
      }
    catch (const std::runtime_error &error)
      {
        throw InputError(place(path) + fmt::format("{} {}", shown_key(name), error.what()));
      }
  }

  std::vector<std::string> CaseFile::files() const
  {
    std::vector<std::string> result{ file_ };
    for (const std::string &key : keys_ending_with(".file"))
      if (text(key) != "none")
        result.push_back((std::filesystem::path(file_).parent_path() / text(key)).string());
    return result;
  }

  std::string CaseFile::inputs() const
  {
    std::string result = resolved();
    for (const std::string &key : keys_ending_with(".file"))
      if (text(key) != "none")
        result += digest("content of " + key, text_of_file(key));
    return result;
  }

  void CaseFile::require_all_used() const
  {
    for (const auto &[path, entry] : entries_)
      if (!entry.used && !entry.copied)
        throw InputError(place(path) + "has no effect here: nothing in this case reads it; remove it");
  }

  bool CaseFile::copied(const std::string &path) const
  {
    const auto it = entries_.find(path);
    return it != entries_.end() && it->second.copied;
  }

  int CaseFile::count(const std::string &list) const
  {
    int n = 0;
    while (has_any(fmt::format("{}[{}].", list, n + 1)))
      ++n;
    if (const auto none = entries_.find(list + "[]"); none != entries_.end())
      none->second.used = true;
    for (const auto &[path, entry] : entries_)
      if (path.starts_with(list + "[") && std::atoi(path.c_str() + list.size() + 1) > n)
        throw InputError(fmt::format("{}there is no {}[{}] before it", place(path), list, n + 1));
    return n;
  }

  std::string CaseFile::place(const std::string &path) const
  {
    if (const auto it = entries_.find(path); it != entries_.end())
      return fmt::format("{}: {} = {}: ", it->second.where, path, shown_key(it->second.shown));
    return fmt::format("{}: {}: ", file_, path);
  }

  const CaseFile::Entry &CaseFile::required(const std::string &path) const
  {
    const auto it = entries_.find(path);
    if (it == entries_.end())
      throw InputError(
          fmt::format("{}: {}: missing; needed is {}", file_, path, schema_->find(path)->allowed()));
    it->second.used = true;
    return it->second;
  }

  std::string CaseFile::text(const std::string &path) const
  {
    return has(path) ? std::get<std::string>(required(path).value) : schema_->find(path)->fallback;
  }

  double CaseFile::number(const std::string &path) const
  {
    if (!has(path))
      {
        char        *end   = nullptr;
        const Key   *key   = schema_->find(path);
        const double value = std::strtod(key->fallback.c_str(), &end);
        if (end != key->fallback.c_str() && *end == '\0')
          return value;
      }
    return std::get<double>(required(path).value);
  }

  std::optional<double> CaseFile::optional_number(const std::string &path) const
  {
    return has(path) ? std::optional(number(path)) : std::nullopt;
  }

  int CaseFile::integer(const std::string &path) const
  {
    const std::string &fallback = schema_->find(path)->fallback;
    if (!has(path) && !fallback.empty() && std::isdigit(static_cast<unsigned char>(fallback[0])))
      return std::atoi(fallback.c_str());
    return static_cast<int>(std::get<long>(required(path).value));
  }

  std::vector<double> CaseFile::numbers(const std::string &path) const
  {
    return std::get<std::vector<double>>(required(path).value);
  }

  std::vector<std::string> CaseFile::texts(const std::string &path) const
  {
    return has(path) ? std::get<std::vector<std::string>>(required(path).value) : std::vector<std::string>();
  }

  std::string CaseFile::resolved() const
  {
    std::string result;
    for (const Key &key : schema_->keys())
      for (const auto &[path, entry] : entries_)
        if (path == key.path || (path.find('[') != std::string::npos && Schema::spelled(path) == key.path))
          result += fmt::format("{} = {}\n", path, entry.shown);
    for (const auto &[path, entry] : entries_) // a list that is given and empty
      if (path.ends_with("[]"))
        result += fmt::format("{} = []\n", path.substr(0, path.size() - 2));
    return result;
  }
} // namespace flank
