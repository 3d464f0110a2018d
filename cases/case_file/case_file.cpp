// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/case_file.hpp"

#include "cases/case_file/toml_text.hpp"
#include "cases/case_file/value.hpp"
#include "cases/work/checked_file.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace flank
{
  namespace
  {
    std::string shown_key(const std::string &path)
    {
      return path.size() > 80 ? fmt::format("{}... ({} letters)", path.substr(0, 80), path.size()) : path;
    }

    constexpr const char *of_command_line = "--set";

    /// A text as TOML has it.
    std::string in_quotes(const std::string &text)
    {
      std::string result = "\"";
      for (const char c : text)
        result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
      return result + "\"";
    }

    /// What the parser says, without what it quotes of the file.
    std::string reason(const toml::parse_error &error)
    {
      const std::string_view text = error.description();
      const auto quote = text.find_first_of("'\"");
      return std::string(text.substr(0, quote)) + (quote == std::string_view::npos ? "" : "...");
    }
  } // namespace

  /// Takes over the entries of a parsed text, table by table.
  class CaseFile::Reader
  {
  public:
    /// `setting_where`: of a setting, what stands before messages; empty: of a file, whose line does.
    Reader(CaseFile &file, const std::string &setting_where)
        : file_(file)
        , schema_(*file.schema_)
        , setting_where_(setting_where)
    {
    }

    /// All of a text. Of a setting the first `named` names are its key's, which may number a table.
    void root(const toml::table &table, const int named) { entries(table, "", named); }

  private:
    void entries(const toml::table &table, const std::string &prefix, const int named = 0)
    {
      for (const auto &[name, node] : table)
        {
          const std::string path = prefix + std::string(name.str());
          if (name.str().find_first_of(named > 0 ? "." : ".[]") != std::string_view::npos)
            throw InputError(fmt::format("{}: {}: a name in quotes is no path; write its tables and keys "
                                         "without them",
                                         where(node), shown_key(path)));
          if (path == "study" && setting_where_.empty())
            file_.has_study_ = true;
          else
            entry(path, node, named - 1);
        }
    }

    /// A table inside another one, which would say nothing if it were empty.
    void inner(const toml::node &node, const std::string &path, const int named)
    {
      if (node.as_table()->empty() && (path.find('.') != std::string::npos || !setting_where_.empty()))
        throw InputError(fmt::format("{}: {} is empty: must be a table of keys such as {}", where(node), path,
                                     schema_.nearest(Schema::spelled(path) + ".")));
      entries(*node.as_table(), path + ".", named);
    }

    std::string where(const toml::node &node) const
    {
      return setting_where_.empty() ? fmt::format("{}:{}", file_.file_, node.source().begin.line)
                                    : setting_where_;
    }

    bool is_lead(const std::string &start) const
    {
      return std::any_of(schema_.keys().begin(), schema_.keys().end(),
                         [&](const Key &key) { return key.path.starts_with(start); });
    }

    void entry(const std::string &path, const toml::node &node, const int named)
    {
      if (path.size() > most_key_letters)
        throw InputError(fmt::format("{}: {}: unknown key; none has more than {} letters", where(node),
                                     shown_key(path), most_key_letters));
      const std::string general = Schema::spelled(path);
      if (is_lead(general + "[]."))
        list(path, general, node);
      else if (const Key *key = schema_.find(path))
        file_.entries_[path] = { value_of(*key, node, where(node) + ": " + path), toml_text(node),
                                 where(node) };
      else if (is_lead(general + "."))
        {
          if (!node.is_table())
            throw InputError(fmt::format("{}: {} = {}: must be a table of keys such as {}", where(node), path,
                                         shown_value(node), schema_.nearest(path)));
          inner(node, path, named);
        }
      else
        throw InputError(fmt::format(
            "{}: unknown key {}{}; the nearest known key is {} (all keys: flank schema)", where(node), path,
            node.is_table() ? "" : " = " + shown_value(node), schema_.nearest(path)));
    }

    /// A list of tables replaces the one that was there.
    void list(const std::string &path, const std::string &general, const toml::node &node)
    {
      const toml::array *array = node.as_array();
      if (!array)
        throw InputError(fmt::format("{}: {}: must be a list of tables: {} = [ {{ ... }}, {{ ... }} ]",
                                     where(node), path, path));
      std::erase_if(file_.entries_, [&](const auto &entry) { return entry.first.starts_with(path + "["); });
      if (array->size() > most_tables)
        throw InputError(fmt::format("{}: {}: {} tables, at most {} are allowed", where(node), path,
                                     array->size(), most_tables));
      if (array->empty()) // says "none", where `like` would copy some
        file_.entries_[path + "[]"] = { {}, "[]", where(node) };
      int index = 0;
      for (const toml::node &item : *array)
        {
          const std::string name = fmt::format("{}[{}]", path, ++index);
          if (!item.is_table())
            throw InputError(fmt::format("{}: {} = {}: must be a table of keys such as {}", where(node), name,
                                         shown_value(item), schema_.nearest(general + "[].")));
          inner(item, name, 0);
        }
    }

    CaseFile &file_;
    const Schema &schema_;
    const std::string &setting_where_;
  };

  void CaseFile::add_text(const std::string &content, const std::string &name,
                          const std::string &setting_where)
  {
    const bool is_setting = !setting_where.empty();
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

    const std::string key = content.substr(0, content.find('='));
    Reader(*this, setting_where)
        .root(root, is_setting ? 1 + static_cast<int>(std::count(key.begin(), key.end(), '.')) : 0);
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
    result.file_ = file;
    result.source_ = std::move(content);
    result.add_text(result.source_, file);
    for (const std::string &setting : settings)
      result.add_setting(setting, of_command_line);
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
    std::string quoted;
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, '.');)
      quoted +=
          (quoted.empty() ? "" : ".") + (part.find('[') == std::string::npos ? part : "\"" + part + "\"");
    add_text(quoted + " = " + (bare ? in_quotes(value) : value), setting, where);
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
    for (const double value : result)
      if (value > 0 && value < least)
        throw InputError(place(path) + fmt::format("{:g} is too little to be told from nothing: must be 0 or "
                                                   "at least {:g}",
                                                   value, least));
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
        if (path == key.path || (path.find('[') != std::string::npos && Schema::spelled(path) == key.path))
          result += fmt::format("{} = {}\n", path, entry.shown);
    for (const auto &[path, entry] : entries_) // a list that is given and empty
      if (path.ends_with("[]"))
        result += fmt::format("{} = []\n", path.substr(0, path.size() - 2));
    return result;
  }
} // namespace flank
