// SPDX-License-Identifier: GPL-2.0-or-later
// How a case takes over the text of its file and the settings of the command line.
#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"
#include "cases/case_file/toml_text.hpp"
#include "cases/case_file/value.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace flank
{
  namespace
  {
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

    /// Reads all of a text. In a setting of the command line the first `named` names are those of its key,
    /// which may number a table.
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

    void entry(const std::string &path, const toml::node &node, const int named)
    {
      if (path.size() > most_key_letters)
        throw InputError(fmt::format("{}: {}: unknown key; none has more than {} letters", where(node),
                                     shown_key(path), most_key_letters));
      const std::string general = Schema::spelled(path);
      if (schema_.leads(general + "[]."))
        list(path, general, node);
      else if (const Key *key = schema_.find(path); key && !(node.is_table() && schema_.leads(general + ".")))
        {
          // "accuracy" and "accuracy.mean_te_percent" say the same in two ways: the later one holds.
          if (const auto dot = path.find('.'); dot != std::string::npos)
            file_.entries_.erase(path.substr(0, dot));
          else
            file_.erase_beginning(path + ".");
          file_.entries_[path] = { value_of(*key, node, where(node) + ": " + path), toml_text(node),
                                   where(node) };
        }
      else if (schema_.leads(general + "."))
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
      file_.erase_beginning(path + "[");
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
        root =
            toml::parse(std::string_view(content), is_setting ? std::string_view() : std::string_view(name));
      }
    catch (const toml::parse_error &error)
      {
        throw InputError(
            is_setting
                ? fmt::format("{} {}: not valid: {}", setting_where, shown_key(name), reason(error))
                : fmt::format("{}:{}: not valid TOML: {}", name, error.source().begin.line, reason(error)));
      }
    if (!is_setting && !root.contains("scene"))
      throw InputError(fmt::format("{}: scene: missing; needed is {}: {}", name,
                                   schema_->find("scene")->allowed(), schema_->find("scene")->meaning));

    const std::string key = content.substr(0, content.find('='));
    Reader(*this, setting_where)
        .root(root, is_setting ? 1 + static_cast<int>(std::count(key.begin(), key.end(), '.')) : 0);
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
    const bool is_table = value.starts_with('{') && schema_->leads(path + ".");
    const bool bare = key && key->type == Key::Type::text && !value.starts_with('"') &&
                      !value.starts_with('\'') && !is_table;
    // A numbered table of a list is a name of its own to TOML.
    std::string quoted;
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, '.');)
      quoted +=
          (quoted.empty() ? "" : ".") + (part.find('[') == std::string::npos ? part : "\"" + part + "\"");
    add_text(quoted + " = " + (bare ? in_quotes(value) : value), setting, where);
  }
} // namespace flank
