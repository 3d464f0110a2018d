// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/design_table.hpp"

#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"
#include "cases/files/checked_file.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace flank
{
  namespace
  {
    /// Where a line's first cell ends: at a comma outside quotes. npos: at the line's end.
    std::size_t end_of_cell(const std::string_view line)
    {
      bool quoted = false;
      for (std::size_t i = 0; i < line.size(); ++i)
        if (line[i] == '"')
          quoted = !quoted;
        else if (line[i] == ',' && !quoted)
          return i;
      return std::string_view::npos;
    }

    /// A line's cells as they stand there, without blanks around them.
    void cells_of(std::string_view line, std::vector<std::string_view> &cells)
    {
      cells.clear();
      for (bool more = true; more;)
        {
          const auto comma = end_of_cell(line);
          more = comma != std::string_view::npos;
          const std::string_view cell = line.substr(0, comma);
          const auto begin = cell.find_first_not_of(" \t\r"), end = cell.find_last_not_of(" \t\r");
          cells.push_back(begin == std::string_view::npos ? std::string_view()
                                                          : cell.substr(begin, end - begin + 1));
          line.remove_prefix(more ? comma + 1 : line.size());
        }
    }

    /// What a cell says: spreadsheets put quotes around some.
    std::string_view unquoted(const std::string_view cell)
    {
      const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
      return quoted ? cell.substr(1, cell.size() - 2) : cell;
    }

    /// Reads one file.
    class DesignReader
    {
    public:
      DesignReader(const Schema &schema, const std::string &name, const std::string &where,
                   const CountValues &count)
          : schema_(schema)
          , name_(shown_key(name))
          , count_(count)
      {
        std::string content;
        try
          {
            content = text_of(name, CaseFile::most_table_bytes);
          }
        catch (const std::runtime_error &error)
          {
            throw InputError(fmt::format("{}: file: {} {}; {}", where, name_, error.what(), needed));
          }
        read(content);
        if (designs.points.empty())
          throw InputError(fmt::format("{}: file: {} has no rows; {}", where, name_, needed));
      }

      DesignTable designs;

    private:
      static constexpr const char *needed =
          "needed are keys in the first line, then a design a line, with commas";

      [[noreturn]] void refuse(const std::string &what) const
      {
        throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
      }

      void read(std::string_view content)
      {
        std::vector<std::string_view> cells;
        while (!content.empty())
          {
            ++line_;
            const auto end = std::min(content.find('\n'), content.size());
            const std::string_view row = content.substr(0, end);
            content.remove_prefix(std::min(end + 1, content.size()));
            if (row.empty() || row[0] == '#' || row == "\r")
              continue;
            cells_of(row, cells);
            if (designs.keys.empty())
              read_keys(cells);
            else
              read_point(cells);
          }
      }

      void read_keys(const std::vector<std::string_view> &cells)
      {
        for (std::size_t c = 0; c < cells.size(); ++c)
          {
            designs.keys.emplace_back(unquoted(cells[c]));
            if (!schema_.find(designs.keys.back()))
              refuse(
                  fmt::format("column {} does not name a key; {} (all keys: flank schema)", c + 1, needed));
          }
      }

      void read_point(const std::vector<std::string_view> &cells)
      {
        if (cells.size() != designs.keys.size())
          refuse(counted(cells.size(), "value") + " for " + counted(designs.keys.size(), "key"));
        count_(cells.size());
        std::vector<std::string> &point = designs.points.emplace_back();
        point.reserve(cells.size());
        for (std::size_t c = 0; c < cells.size(); ++c)
          {
            if (cells[c].empty())
              refuse(fmt::format("cell {} is empty: needed is a value of {}", c + 1, designs.keys[c]));
            point.emplace_back(unquoted(cells[c]));
          }
      }

      const Schema &schema_;
      const std::string name_;
      const CountValues &count_;
      int line_ = 0;
    };
  } // namespace

  DesignTable read_designs(const Schema &schema, const std::string &file, const std::string &where,
                           const CountValues &count)
  {
    return DesignReader(schema, file, where, count).designs;
  }
} // namespace flank
