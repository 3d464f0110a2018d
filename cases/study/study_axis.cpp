// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study_axis.hpp"

#include "cases/case_file/toml_text.hpp"
#include "cases/study/design_table.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

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

    std::string place(const CaseFile &base, const toml::node &node)
    {
      return fmt::format("{}:{}: [[study]]", base.file(), node.source().begin.line);
    }

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

    /// Reads one [[study]] table.
    class AxisReader
    {
    public:
      /// `n_values`: on all axes up to here, counted on.
      AxisReader(const CaseFile &base, const toml::table &table, const std::string &where, double &n_values)
          : base_(base)
          , table_(table)
          , where_(where)
          , n_values_(n_values)
          , axis_{ .where = where,
                   .keys = {},
                   .points = {},
                   .is_range = false,
                   .together_with_previous = false,
                   .file = {} }
      {
      }

      StudyAxis read()
      {
        require_known_keys();
        read_keys();
        axis_.together_with_previous = table_["together_with_previous"].value_or(false);
        if (table_.contains("values"))
          for (const toml::node &value : array("values"))
            axis_.points.emplace_back(axis_.keys.size(), toml_text(value));
        else if (table_.contains("rows"))
          read_rows();
        else if (table_.contains("file"))
          {
            axis_.file =
                (std::filesystem::path(base_.file()).parent_path() / table_["file"].value_or(std::string()))
                    .string();
            DesignTable designs = read_designs(base_.schema(), axis_.file, where_,
                                               [&](const std::size_t values) { require_few(1, values); });
            axis_.keys = std::move(designs.keys);
            axis_.points = std::move(designs.points);
          }
        else
          read_range();
        return std::move(axis_);
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
          refuse(std::string("says ") + (ways == 0 ? "no values" : "its values in two ways") + "; " +
                 allowed);
        require_type("spacing", toml::node_type::string, "\"linear\" or \"logarithmic\"");
        require_type("file", toml::node_type::string, "the name of a file");
        require_type("together_with_previous", toml::node_type::boolean, "true or false");
      }

      void require_type(const char *name, const toml::node_type type, const char *what) const
      {
        if (const toml::node *node = table_.get(name); node && node->type() != type)
          refuse(fmt::format("{} = {}: must be {}", name, shortened(toml_text(*node)), what));
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
        if (n_values_ > StudyAxis::most_values)
          refuse(fmt::format("{:.0f} values on all axes up to here, at most {} are read", n_values_,
                             StudyAxis::most_values));
      }

      const toml::array &array(const char *name)
      {
        const toml::array *values = table_[name].as_array();
        if (!values || values->empty())
          refuse(
              fmt::format("{} = {}: must be a list that is not empty", name, toml_text(*table_.get(name))));
        require_few(values->size(), axis_.keys.size());
        return *values;
      }

      void read_rows()
      {
        for (const toml::node &row : array("rows"))
          {
            const toml::array *values = row.as_array();
            if (!values || values->size() != axis_.keys.size())
              refuse(fmt::format("rows: {} must be a list of {}, one for each key of set", toml_text(row),
                                 counted(axis_.keys.size(), "value")));
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
      const std::string where_;
      double &n_values_;
      StudyAxis axis_;
    };
  } // namespace

  std::string shortened(const std::string &text)
  {
    return text.size() > 80 ? text.substr(0, 80) + "..." : text;
  }

  std::vector<StudyAxis> read_axes(const CaseFile &base)
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
    std::vector<StudyAxis> axes;
    double n_values = 0;
    for (const toml::node &item : *list)
      axes.push_back(AxisReader(base, *item.as_table(), place(base, item), n_values).read());
    return axes;
  }
} // namespace flank
