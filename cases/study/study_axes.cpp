// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study_axes.hpp"

#include "cases/case_file/printable.hpp"
#include "cases/case_file/toml_text.hpp"
#include "cases/case_file/value.hpp"
#include "cases/study/design_table.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

namespace flank
{
  namespace
  {
    const char *allowed =
        "allowed are set with values, rows or from, to, count, spacing; or file; and together_with_previous";

    double to_12_digits(const double value)
    {
      char text[32];
      const auto end = fmt::format_to(text, "{:.12g}", value);
      double result = 0;
      std::from_chars(text, end, result);
      return result;
    }

    /// A range's values: ends exact, the others to 12 digits, so that names of designs stay short.
    std::vector<double> range(const double from, const double to, const long count, const bool logarithmic)
    {
      std::vector<double> values;
      for (long k = 0; k < count; ++k)
        {
          const double t = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0;
          const double value = logarithmic ? from * std::pow(to / from, t) : from + t * (to - from);
          values.push_back(k == 0 ? from : k == count - 1 ? to : to_12_digits(value));
        }
      return values;
    }

    std::string place(const CaseFile &base, const toml::node &node)
    {
      return fmt::format("{}:{}: [[study]]", base.file(), node.source().begin.line);
    }

    std::string shown(const std::string &text)
    {
      return text.size() > 80 ? text.substr(0, 80) + "..." : text;
    }
  } // namespace

  /// Reads one [[study]] table.
  class StudyAxes::AxisReader
  {
  public:
    /// `n_values`: on all axes up to here, counted on.
    AxisReader(const StudyAxes &axes, const toml::table &table, const std::string &where, double &n_values)
        : base_(axes.base_)
        , table_(table)
        , where_(where)
        , n_values_(n_values)
        , axis_{ .where = where, .keys = {}, .points = {}, .is_range = false }
    {
    }

    /// With the file that it is read from, where there is one.
    std::pair<Axis, std::string> read()
    {
      require_known_keys();
      read_keys();
      std::string file;
      if (table_.contains("values"))
        for (const toml::node &value : array("values"))
          axis_.points.emplace_back(axis_.keys.size(), toml_text(value));
      else if (table_.contains("rows"))
        read_rows();
      else if (table_.contains("file"))
        {
          file = (std::filesystem::path(base_.file()).parent_path() / table_["file"].value_or(std::string()))
                     .string();
          DesignTable designs = read_designs(base_.schema(), file, where_,
                                             [&](const std::size_t values) { require_few(1, values); });
          axis_.keys = std::move(designs.keys);
          axis_.points = std::move(designs.points);
        }
      else
        read_range();
      return { std::move(axis_), file };
    }

  private:
    [[noreturn]] void refuse(const std::string &what) const { throw InputError(where_ + ": " + what); }

    bool is_range() const
    {
      return table_.contains("from") || table_.contains("to") || table_.contains("count") ||
             table_.contains("spacing");
    }

    void require_known_keys() const
    {
      static const std::vector<std::string_view> known = { "set",     "values", "rows",
                                                           "from",    "to",     "count",
                                                           "spacing", "file",   "together_with_previous" };
      for (const auto &[name, node] : table_)
        if (std::find(known.begin(), known.end(), name.str()) == known.end())
          throw InputError(
              fmt::format("{}: unknown key {}; {}", place(base_, node), std::string(name.str()), allowed));
      const int ways =
          table_.contains("values") + table_.contains("rows") + is_range() + table_.contains("file");
      if (ways != 1)
        refuse(std::string("says ") + (ways == 0 ? "no values" : "its values in two ways") + "; " + allowed);
      require_type("spacing", toml::node_type::string, "\"linear\" or \"logarithmic\"");
      require_type("file", toml::node_type::string, "the name of a file");
      require_type("together_with_previous", toml::node_type::boolean, "true or false");
    }

    void require_type(const char *name, const toml::node_type type, const char *what) const
    {
      if (const toml::node *node = table_.get(name); node && node->type() != type)
        refuse(fmt::format("{} = {}: must be {}", name, shown(toml_text(*node)), what));
    }

    void read_keys()
    {
      if (const toml::node *set = table_.get("set"))
        {
          if (set->is_string())
            axis_.keys.push_back(set->as_string()->get());
          else if (const toml::array *keys = set->as_array();
                   keys && !keys->empty() && keys->is_homogeneous(toml::node_type::string))
            for (const toml::node &key : *keys)
              axis_.keys.push_back(key.as_string()->get());
          else
            refuse(fmt::format("set = {}: must be a key or a list of keys", toml_text(*set)));
        }
      if (axis_.keys.empty() != table_.contains("file"))
        refuse(table_.contains("file") ? "set: the keys stand in the first line of the file"
                                       : "set: missing; which keys the values are for");
    }

    /// Before they are made: a short line says many.
    void require_few(const std::size_t points, const std::size_t keys)
    {
      n_values_ += static_cast<double>(points * keys);
      if (n_values_ > most_values)
        refuse(
            fmt::format("{:.0f} values on all axes up to here, at most {} are read", n_values_, most_values));
    }

    const toml::array &array(const char *name)
    {
      const toml::array *values = table_[name].as_array();
      if (!values || values->empty())
        refuse(fmt::format("{} = {}: must be a list that is not empty", name, toml_text(*table_.get(name))));
      require_few(values->size(), axis_.keys.size());
      return *values;
    }

    void read_rows()
    {
      for (const toml::node &row : array("rows"))
        {
          const toml::array *values = row.as_array();
          if (!values || values->size() != axis_.keys.size())
            refuse(fmt::format("rows: {} must be a list of {} values, one for each key of set",
                               toml_text(row), axis_.keys.size()));
          axis_.points.emplace_back();
          for (const toml::node &value : *values)
            axis_.points.back().push_back(toml_text(value));
        }
    }

    double number(const char *name) const
    {
      if (!table_.contains(name) || !table_.get(name)->is_number())
        refuse(fmt::format("{}: missing or not a number; a range is from, to, count", name));
      return toml_number(*table_.get(name));
    }

    void read_range()
    {
      const double from = number("from"), to = number("to"), count = number("count");
      const std::string spacing = table_["spacing"].value_or(std::string("linear"));
      if (count < 1 || count > 1e6 || count != std::floor(count))
        refuse(fmt::format("count = {}: must be an integer from 1 to 1000000", count));
      if (spacing != "linear" && spacing != "logarithmic")
        refuse(
            fmt::format("spacing = {}: unknown choice, allowed is \"linear\" or \"logarithmic\"", spacing));
      if (spacing == "logarithmic" && !(from > 0 && to > 0))
        refuse("a logarithmic range needs from and to above 0");
      if (count == 1 && from != to)
        refuse("count = 1: from and to differ; give values, or a count of at least 2");
      require_few(static_cast<std::size_t>(count), axis_.keys.size());
      axis_.is_range = true;
      bool whole = true; // integers stay integers: some keys take nothing else
      const auto values = range(from, to, static_cast<long>(count), spacing == "logarithmic");
      for (const double value : values)
        whole = whole && value == std::floor(value) && std::abs(value) < 1e15;
      for (const double value : values)
        axis_.points.emplace_back(axis_.keys.size(), whole ? fmt::format("{}", static_cast<long>(value))
                                                           : fmt::format("{}", value));
    }

    const CaseFile &base_;
    const toml::table &table_;
    const std::string &where_;
    double &n_values_;
    Axis axis_;
  };

  StudyAxes::StudyAxes(const CaseFile &base)
      : base_(base)
  {
    const toml::table root =
        toml::parse(std::string_view(base.source()), std::string_view(base.file())); // was valid before
    if (!root.contains("study"))
      throw InputError(
          fmt::format("{}: there is no [[study]] in it; add one, or use flank run", base.file()));
    const toml::array *list = root["study"].as_array();
    if (!list || list->empty() || !list->is_array_of_tables())
      throw InputError(fmt::format("{}: study must be a list of tables, [[study]]; {}",
                                   place(base, *root.get("study")), allowed));
    double n_values = 0;
    for (const toml::node &item : *list)
      {
        const std::string where = place(base, item);
        auto [axis, file] = AxisReader(*this, *item.as_table(), where, n_values).read();
        if (!file.empty())
          files_.push_back(file);
        add(std::move(axis), (*item.as_table())["together_with_previous"].value_or(false));
      }
    for (const Axis &axis : axes_)
      if (std::none_of(axis.keys.begin(), axis.keys.end(), [&](const auto &key) { return varies(key); }))
        throw InputError(
            fmt::format("{}: {} changes nothing that is computed; a title stands beside the keys "
                        "that it names values of",
                        axis.where, fmt::join(axis.keys, ", ")));
    if (n_variants() > most_variants)
      throw InputError(fmt::format("{}: {} variants are more than 1e8; make the axes shorter",
                                   axes_.front().where, n_variants()));
    base_.forget_source();
    check_values();
    require_distinct_points();
  }

  bool StudyAxes::varies(const std::string &key) const
  {
    const Key *known = base_.schema().find(key);
    return key != "title" && !(known && known->type == Key::Type::text && known->choices.size() == 1);
  }

  void StudyAxes::add(Axis axis, const bool together_with_previous)
  {
    const auto refuse = [&](const std::string &what) { throw InputError(axis.where + ": " + what); };
    for (const std::string &key : axis.keys)
      {
        if ((key == "output" || key.starts_with("output.")) && key != "output.derivatives")
          refuse(fmt::format("{} cannot vary in a study; flank run of one variant has it", shown(key)));
        for (const std::string &other : keys_)
          if (CaseFile::overlap(key, other))
            refuse(fmt::format("{} is set by an axis before{}", shown(key),
                               other == key ? "" : ", which sets " + shown(other)));
        keys_.push_back(key);
      }
    if (!together_with_previous)
      {
        axes_.push_back(std::move(axis));
        return;
      }
    if (axes_.empty() || axes_.back().points.size() != axis.points.size())
      refuse(axes_.empty() ? std::string("together_with_previous: there is none before it")
                           : fmt::format("together_with_previous: {} points here, {} there",
                                         axis.points.size(), axes_.back().points.size()));
    Axis &before = axes_.back();
    before.is_range = before.is_range && axis.is_range;
    before.keys.insert(before.keys.end(), axis.keys.begin(), axis.keys.end());
    for (std::size_t k = 0; k < axis.points.size(); ++k)
      before.points[k].insert(before.points[k].end(), axis.points[k].begin(), axis.points[k].end());
  }

  void StudyAxes::check_values() const
  {
    for (const Axis &axis : axes_)
      {
        std::vector<const Key *> keys;
        for (const std::string &key : axis.keys)
          keys.push_back(base_.schema().find(key));
        for (std::size_t p = 0; p < axis.points.size();
             p = axis.is_range && p == 1 ? std::max<std::size_t>(2, axis.points.size() - 1) : p + 1)
          {
            const std::vector<std::string> &point = axis.points[p];
            bool plain = p > 0; // keys are checked with the first point
            for (std::size_t k = 0; k < keys.size() && plain; ++k)
              plain = keys[k] && is_plainly_allowed(*keys[k], point[k]);
            if (plain)
              continue;
            std::vector<std::string> settings;
            for (std::size_t k = 0; k < keys.size(); ++k)
              settings.push_back(axis.keys[k] + "=" + point[k]);
            if (p == 0)
              base_.with(settings, axis.where);
            else
              base_.check(settings, axis.where);
          }
      }
  }

  /// What of an axis' points makes a difference: equal where numbers are.
  class StudyAxes::PointText
  {
  public:
    PointText(const std::vector<std::string> &keys, const StudyAxes &axes)
    {
      for (std::size_t k = 0; k < keys.size(); ++k)
        if (axes.varies(keys[k]))
          {
            const Key *key = axes.base_.schema().find(keys[k]);
            columns_.push_back({ k, key && key->type != Key::Type::text });
          }
    }

    std::string of(const std::vector<std::string> &point) const
    {
      std::string result;
      for (const Column &column : columns_)
        if (const auto number = column.is_number ? number_in(point[column.at]) : std::nullopt)
          {
            const double value = *number + 0.0; // no minus zero
            result.append(reinterpret_cast<const char *>(&value), sizeof value);
          }
        else
          result += point[column.at] + '\n';
      return result;
    }

  private:
    struct Column
    {
      std::size_t at;
      bool is_number;
    };
    std::vector<Column> columns_;
  };

  void StudyAxes::require_distinct_points() const
  {
    const auto refuse = [](const Axis &axis, const std::size_t one, const std::size_t other) {
      throw InputError(fmt::format("{}: points {} and {} are equal ({}): they would make equal variants; "
                                   "leave one out",
                                   axis.where, one + 1, other + 1,
                                   shown(fmt::format("{}", fmt::join(axis.points[other], ", ")))));
    };
    for (const Axis &axis : axes_)
      {
        const std::size_t n = axis.points.size();
        if (axis.is_range) // ascends or descends
          {
            for (std::size_t p = 1; p < n; ++p)
              if (axis.points[p] == axis.points[p - 1])
                refuse(axis, p - 1, p);
            continue;
          }
        const PointText compared(axis.keys, *this);
        std::vector<std::pair<std::size_t, std::size_t>> by_hash; // with the point
        by_hash.reserve(n);
        for (std::size_t p = 0; p < n; ++p)
          by_hash.emplace_back(std::hash<std::string>()(compared.of(axis.points[p])), p);
        std::sort(by_hash.begin(), by_hash.end());
        for (std::size_t p = 1; p < n; ++p)
          if (by_hash[p].first == by_hash[p - 1].first &&
              compared.of(axis.points[by_hash[p].second]) == compared.of(axis.points[by_hash[p - 1].second]))
            refuse(axis, by_hash[p - 1].second, by_hash[p].second);
      }
  }

  void StudyAxes::require_no_settings() const
  {
    for (const Axis &axis : axes_)
      for (const std::string &key : axis.keys)
        if (const std::string setting = base_.setting_of(key); !setting.empty())
          throw InputError(fmt::format("{}: {} is set by {} too, which would have no effect; leave it out",
                                       axis.where, shown(key), setting));
  }

  long StudyAxes::n_variants() const
  {
    double n = 1;
    for (const Axis &axis : axes_)
      n *= static_cast<double>(axis.points.size());
    return n > 1e18 ? static_cast<long>(1e18) : std::lround(n);
  }

  std::vector<std::size_t> StudyAxes::point_of(long variant) const
  {
    std::vector<std::size_t> point(axes_.size());
    for (std::size_t a = axes_.size(); a-- > 0;)
      {
        const auto n = static_cast<long>(axes_[a].points.size());
        point[a] = static_cast<std::size_t>(variant % n);
        variant /= n;
      }
    return point;
  }

  std::vector<std::string> StudyAxes::values(const long variant) const
  {
    const auto point = point_of(variant);
    std::vector<std::string> result;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      result.insert(result.end(), axes_[a].points[point[a]].begin(), axes_[a].points[point[a]].end());
    return result;
  }

  double StudyAxes::letters() const
  {
    double sum = 0;
    for (const Axis &axis : axes_)
      {
        double of_axis = 0;
        for (const auto &point : axis.points)
          for (const std::string &value : point)
            of_axis += static_cast<double>(value.size());
        sum += of_axis / static_cast<double>(axis.points.size()) * static_cast<double>(n_variants());
      }
    return sum;
  }

  std::vector<long> StudyAxes::shape() const
  {
    std::vector<long> result;
    for (const Axis &axis : axes_)
      result.push_back(static_cast<long>(axis.points.size()));
    return result;
  }

  long StudyAxes::variant_on_axis(const std::size_t axis, const long point) const
  {
    long step = 1;
    for (std::size_t a = axis + 1; a < axes_.size(); ++a)
      step *= static_cast<long>(axes_[a].points.size());
    return point * step;
  }

  CaseFile StudyAxes::variant(const long number) const
  {
    std::vector<std::string> settings;
    const std::vector<std::string> own = values(number);
    for (std::size_t k = 0; k < keys_.size(); ++k)
      settings.push_back(keys_[k] + "=" + own[k]);
    return base_.with(settings, fmt::format("{} variant {}", base_.file(), number));
  }

  std::string StudyAxes::text() const
  {
    std::string result;
    for (const Axis &axis : axes_)
      {
        result += fmt::format("study of {}:", fmt::join(axis.keys, ", "));
        for (const auto &point : axis.points)
          result += fmt::format(" ({})", fmt::join(point, ", "));
        result += "\n";
      }
    return result;
  }
} // namespace flank
