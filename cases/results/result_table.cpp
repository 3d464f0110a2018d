// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/result_table.hpp"

#include "cases/results/hdf5_file.hpp"
#include "cases/work/result_folder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace flank
{
  namespace
  {
    /// A field of the CSV file.
    void append(fmt::memory_buffer &text, const ResultTable::Column &column, const double value)
    {
      const auto to = std::back_inserter(text);
      if (std::isnan(value))
        fmt::format_to(to, "{}", column.missing);
      else if (!column.words.empty())
        fmt::format_to(to, "{}", column.words.at(static_cast<std::size_t>(value)));
      else if (column.is_whole())
        fmt::format_to(to, "{}", static_cast<long>(value));
      else
        fmt::format_to(to, fmt::runtime(column.format), value);
    }
  } // namespace

  ResultTable::ResultTable(std::string name, std::string heading, std::vector<Column> columns,
                           const Variant variant)
      : name_(std::move(name))
      , heading_(std::move(heading))
      , columns_(std::move(columns))
      , variant_(variant)
      , values_(columns_.size())
  {
  }

  void ResultTable::add(const std::vector<double> &row)
  {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      values_[c].push_back(row.at(c));
  }

  ResultTable ResultTable::of_variants(std::string name) const
  {
    std::vector<Column> columns = { { "variant", "1", "{}" } };
    columns.insert(columns.end(), columns_.begin(), columns_.end());
    return { std::move(name), heading_, std::move(columns), Variant::without };
  }

  void ResultTable::add(const long variant, const ResultTable &rows)
  {
    for (std::size_t r = 0; r < rows.values_.front().size(); ++r)
      {
        values_.front().push_back(static_cast<double>(variant));
        for (std::size_t c = 0; c < rows.columns_.size(); ++c)
          values_.at(c + 1).push_back(rows.values_[c][r]);
      }
  }

  std::string ResultTable::csv() const
  {
    fmt::memory_buffer text;
    const auto to = std::back_inserter(text);
    const bool of_variant = variant_ == Variant::with;
    fmt::format_to(to, "{}{}", heading_, of_variant ? "variant," : "");
    for (std::size_t c = 0; c < columns_.size(); ++c)
      fmt::format_to(to, "{}{}", c > 0 ? "," : "", columns_[c].name);
    for (std::size_t r = 0; r < values_.front().size(); ++r)
      {
        fmt::format_to(to, "{}", of_variant ? "\n0," : "\n");
        for (std::size_t c = 0; c < columns_.size(); ++c)
          {
            if (c > 0)
              text.push_back(',');
            append(text, columns_[c], values_[c][r]);
          }
      }
    text.push_back('\n');
    return fmt::to_string(text);
  }

  void ResultTable::write(const ResultFolder &folder) const
  {
    folder.write(name_ + ".csv", csv());
  }

  void ResultTable::write(Hdf5File &file) const
  {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      {
        const Column &column = columns_[c];
        std::string unit = column.unit;
        for (std::size_t k = 0; k < column.words.size(); ++k)
          unit += fmt::format("{}{} {}", k > 0 ? ", " : "", k, column.words[k]);
        if (column.is_whole() || !column.words.empty())
          file.dataset(name_, column.name, { values_[c].size() },
                       std::vector<int>(values_[c].begin(), values_[c].end()), unit);
        else
          file.dataset(name_, column.name, { values_[c].size() }, values_[c], unit);
      }
  }

  ResultTable::Column torque_column()
  {
    return { "torque_Nm", "N m", "{:.9g}" };
  }

  ResultTable::Column position_column()
  {
    return { "position", "1", "{}" };
  }

  ResultTable::Column phase_column()
  {
    return { "phase", "mesh cycle", "{:.9g}" };
  }

  ResultTable::Column bound_column(const std::string &name, const std::string &unit,
                                   const std::string &format)
  {
    return { name, unit, format, {}, "nan" };
  }

  ResultTable stage_table(const std::vector<std::pair<std::string, double>> &stages)
  {
    std::vector<std::string> names;
    for (const auto &[name, seconds] : stages)
      names.push_back(name);
    ResultTable table("stages", "", { { "stage", "", "{}", names }, { "seconds", "s", "{:.3f}" } });
    for (std::size_t k = 0; k < stages.size(); ++k)
      table.add({ static_cast<double>(k), stages[k].second });
    return table;
  }

  std::vector<ResultTable::Column> harmonic_columns()
  {
    return { torque_column(),
             { "harmonic", "1", "{}" },
             { "amplitude_um", "um", "{:.9f}" },
             { "phase_deg", "deg", "{:.6f}" },
             { "aliased", "0 no, 1 yes", "{}" } };
  }
} // namespace flank
