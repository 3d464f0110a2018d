// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/result_table.hpp"

#include "cases/results/hdf5_file.hpp"
#include "cases/results/result_folder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace flank
{
  ResultTable::ResultTable(std::string name, std::string heading, std::vector<Column> columns)
      : name_(std::move(name))
      , heading_(std::move(heading))
      , columns_(std::move(columns))
      , values_(columns_.size())
  {
  }

  void ResultTable::add(const std::vector<double> &row)
  {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      values_[c].push_back(row.at(c));
  }

  std::string ResultTable::csv() const
  {
    fmt::memory_buffer text;
    const auto         to = std::back_inserter(text);
    fmt::format_to(to, "{}variant", heading_);
    for (const Column &column : columns_)
      fmt::format_to(to, ",{}", column.name);
    for (std::size_t r = 0; r < values_.front().size(); ++r)
      {
        fmt::format_to(to, "\n0");
        for (std::size_t c = 0; c < columns_.size(); ++c)
          {
            const Column &column = columns_[c];
            const double  value  = values_[c][r];
            text.push_back(',');
            if (std::isnan(value))
              continue;
            if (!column.words.empty())
              fmt::format_to(to, "{}", column.words.at(static_cast<std::size_t>(value)));
            else if (column.is_whole())
              fmt::format_to(to, "{}", static_cast<long>(value));
            else
              fmt::format_to(to, fmt::runtime(column.format), value);
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
        std::string   unit   = column.unit;
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
} // namespace flank
