// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"

#include "cases/files/checked_file.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

namespace flank
{
  namespace
  {
    constexpr const char *of_command_line = "--set";
  } // namespace

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
    result.file_ = file;
    result.source_ = std::move(content);
    result.add_text(result.source(), file);
    for (const std::string &setting : settings)
      {
        if (setting.find_first_of("\n\r") != std::string::npos) // the rest would be keys of its own
          throw InputError(
              fmt::format("{} {}: must be one line, of one key", of_command_line, shown_key(setting)));
        result.add_setting(setting, of_command_line);
        result.settings_.push_back(setting);
      }
    result.finish();
    return result;
  }

  CaseFile CaseFile::with(const std::vector<std::string> &settings, const std::string &where) const
  {
    CaseFile result(*schema_);
    result.file_ = file_;
    result.source_ = source_;
    result.has_study_ = has_study_;
    result.named_ = named_;
    result.entries_ = given_;
    result.settings_ = settings_;
    for (const std::string &setting : settings)
      {
        result.add_setting(setting, where);
        result.settings_.push_back(setting);
      }
    result.finish();
    return result;
  }

  std::string CaseFile::source_with_settings() const
  {
    if (settings_.empty())
      return source_;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; // of a file's beginning alone
    std::string head = "# Computed with these settings, which replace keys of the file:\n";
    for (const std::string &setting : settings_)
      head += "#   " + setting + "\n";
    return head + "\n" + source_.substr(source_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  }

  void CaseFile::check(const std::vector<std::string> &settings, const std::string &where) const
  {
    CaseFile file(*schema_);
    for (const std::string &setting : settings)
      file.add_setting(setting, where);
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
    std::map<std::string, Entry> copies;
    for (auto it = entries_.lower_bound(rule.from); it != entries_.end() && it->first.starts_with(rule.from);
         ++it)
      {
        const std::string own = rule.to + it->first.substr(rule.from.size());
        if (std::ranges::any_of(rule.rivals(own), [&](const auto &start) { return has_any(start); }))
          continue;
        Entry copy = it->second;
        copy.copied = true;
        copies.emplace(own, std::move(copy));
      }
    for (const auto &[one, other] : rule.same)
      if (has(one) != has(other))
        copies.erase(has(one) ? other : one);
    entries_.merge(copies);
  }

  void CaseFile::erase_beginning(const std::string &start)
  {
    for (auto it = entries_.lower_bound(start); it != entries_.end() && it->first.starts_with(start);)
      it = entries_.erase(it);
  }

  bool CaseFile::overlap(const std::string &one, const std::string &other)
  {
    const auto &[least, longer] = std::minmax(one, other);
    return longer.starts_with(least) &&
           (longer.size() == least.size() || longer[least.size()] == '.' || longer[least.size()] == '[');
  }

  std::string CaseFile::setting_of(const std::string &path) const
  {
    const auto found = std::find_if(given_.begin(), given_.end(), [&](const auto &entry) {
      return entry.second.where == of_command_line && overlap(entry.first, path);
    });
    return found == given_.end() ? "" : found->second.where;
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

  const std::string &CaseFile::text_of_file(const std::string &path) const
  {
    const std::string name = text(path), at = (std::filesystem::path(file_).parent_path() / name).string();
    try
      {
        return named_->text(name, at);
      }
    catch (const std::runtime_error &error)
      {
        throw InputError(place(path) + fmt::format("{} {}", shown_key(at), error.what()));
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

  void CaseFile::require_study(const std::string &key, const std::string &why) const
  {
    if (!has_study_)
      throw InputError(place(key) + "has no effect here: " + why + ", and there is no [[study]]");
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
    for (auto it = entries_.lower_bound(list + "[");
         it != entries_.end() && it->first.starts_with(list + "["); ++it)
      if (std::atoi(it->first.c_str() + list.size() + 1) > n)
        throw InputError(fmt::format("{}there is no {}[{}] before it", place(it->first), list, n + 1));
    return n;
  }

  std::string CaseFile::place(const std::string &path) const
  {
    if (const auto it = entries_.find(path); it != entries_.end())
      {
        const Entry &entry = it->second;
        const auto place_of = [&](const std::string &given, const std::string &copy) {
          return fmt::format("{}: {} = {}{}: ", entry.where, given, shown_key(entry.shown), copy);
        };
        for (const CopyRule &rule : schema_->copy_rules())
          if (entry.copied && path.starts_with(rule.to))
            return place_of(rule.from + path.substr(rule.to.size()),
                            fmt::format(", which {} copies to {}", rule.key, path));
        return place_of(path, "");
      }
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
        char *end = nullptr;
        const Key *key = schema_->find(path);
        const double value = std::strtod(key->fallback.c_str(), &end);
        if (end != key->fallback.c_str() && *end == '\0')
          return value;
      }
    return std::get<double>(required(path).value);
  }

  std::vector<double> CaseFile::numbers_or_zero(const std::string &path, const double least) const
  {
    std::vector<double> result = numbers(path);
    std::set<std::string> seen; // as tables print them
    for (double &value : result)
      {
        value += 0.0; // no minus zero
        if (value > 0 && value < least)
          throw InputError(place(path) + fmt::format("{:g} is too little to be told from nothing: must be 0 "
                                                     "or at least {:g}",
                                                     value, least));
        if (!seen.insert(fmt::format("{:.9g}", value)).second)
          throw InputError(place(path) + fmt::format("{:.9g} is given twice, to the digits of tables; give "
                                                     "every load once",
                                                     value));
      }
    return result;
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
        if (!entry.copied &&
            (path == key.path || (path.find('[') != std::string::npos && Schema::spelled(path) == key.path)))
          result += fmt::format("{} = {}\n", path, entry.shown);
    for (const auto &[path, entry] : entries_) // a list that is given and empty
      if (path.ends_with("[]") && !entry.copied)
        result += fmt::format("{} = []\n", path.substr(0, path.size() - 2));
    return result;
  }
} // namespace flank
