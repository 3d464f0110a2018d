// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/input/topography_file.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

namespace flank
{
  namespace
  {
    std::vector<std::string> split(const std::string &line)
    {
      // Commas inside parentheses belong to the first cell.
      std::vector<std::string> cells(1);
      int                      depth = 0;
      for (const char c : line)
        {
          depth += c == '(' ? 1 : c == ')' ? -1 : 0;
          if (c == ',' && depth == 0)
            cells.emplace_back();
          else if (c != ' ' && c != '\t' && c != '\r' && c != '"')
            cells.back() += c;
        }
      return cells;
    }
  } // namespace

  std::shared_ptr<const Topography> read_topography(const CaseFile &file, const std::string &key,
                                                    const GearPair &pair, const Gear &gear,
                                                    const RollAngles &roll, const bool mirrored)
  {
    const std::string           name = file.text(key);
    const std::filesystem::path path = std::filesystem::path(file.file()).parent_path() / name;
    std::istringstream          stream(file.text_of_file(key));

    std::vector<double>              rolls, z;
    std::vector<std::vector<double>> rows;
    std::string                      line, header;
    for (int number = 1; std::getline(stream, line); ++number)
      {
        if (line.empty() || line[0] == '#' || line == "\r")
          continue;
        const auto refuse = [&](const std::string &what) {
          throw InputError(
              fmt::format("{}:{}: {} (table of {}, {})", path.string(), number, what, key, file.file()));
        };
        const auto cells = split(line);
        const auto value = [&](const std::size_t column) {
          const std::string &cell = cells[column];
          double             v    = 0;
          const char        *from = cell.c_str() + (cell.starts_with('+') ? 1 : 0);
          const auto         read = std::from_chars(from, cell.data() + cell.size(), v);
          if (cell.empty() || !std::isfinite(v))
            refuse(fmt::format("a hole in column {}; every place needs a number", column + 1));
          if (read.ec != std::errc() || read.ptr != cell.data() + cell.size())
            refuse(fmt::format("column {}: \"{}\" is not a number", column + 1, cell));
          return v;
        };
        if (header.empty())
          {
            header = cells[0];
            if (header != "removed_um(roll_angle_deg,z_mm)" && header != "removed_um(diameter_mm,z_mm)" &&
                header != "removed_um(length_of_roll_mm,z_mm)")
              refuse("the first cell must say quantity, axes and units: removed_um(roll_angle_deg,z_mm), "
                     "removed_um(diameter_mm,z_mm) or "
                     "removed_um(length_of_roll_mm,z_mm)"); // what it is instead may be a foreign file's
            for (std::size_t c = 1; c < cells.size(); ++c)
              z.push_back(value(c));
            if (z.size() < 2)
              refuse("at least two face positions are needed");
            if (!std::is_sorted(z.begin(), z.end(), std::less_equal<>()))
              refuse("the face positions must ascend");
            continue;
          }
        if (cells.size() != z.size() + 1)
          refuse(fmt::format("{} numbers after the first, the first line has {} face positions",
                             cells.size() - 1, z.size()));
        const double at = value(0), rb = gear.base_radius;
        if (header.find("diameter") != std::string::npos && at / 2 < rb)
          refuse(fmt::format("diameter {} mm lies below the base circle, {:.4f} mm", at, 2 * rb));
        rolls.push_back(header.find("diameter") != std::string::npos ? roll_angle(at / 2, rb)
                        : header.find("length") != std::string::npos ? at / rb
                                                                     : at * units::degree);
        if (rolls.size() > 1 && rolls.back() <= rolls[rolls.size() - 2])
          refuse("the first column must ascend");
        rows.emplace_back();
        for (std::size_t c = 1; c < cells.size(); ++c)
          {
            rows.back().push_back(value(c) * units::micrometre);
            if (std::abs(rows.back().back()) > 10)
              refuse(fmt::format("column {}: {} um is more than 10 mm; are these micrometres?", c + 1,
                                 cells[c]));
          }
      }
    if (rows.size() < 2)
      throw InputError(file.place(key) +
                       fmt::format("{} needs a first line and at least two rows", path.string()));

    Eigen::MatrixXd removed(rows.size(), z.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < z.size(); ++j)
        removed(i, j) = rows[i][j];
    if (mirrored)
      {
        std::reverse(z.begin(), z.end());
        for (double &v : z)
          v = -v;
        removed = removed.rowwise().reverse().eval();
      }
    const double offset = gear.name == "gear" ? pair.data.axial_offset : 0, low = pair.face_low - offset,
                 high         = pair.face_high - offset;
    constexpr double rounding = 1e-4; // deg and mm: tables are printed with few digits
    if (rolls.front() > roll.start_of_active_profile + rounding * units::degree ||
        rolls.back() < roll.tip - rounding * units::degree)
      throw InputError(
          file.place(key) +
          fmt::format(
              "the table covers roll angles {:.4f} to {:.4f} deg, the active profile is {:.4f} to {:.4f} deg",
              rolls.front() / units::degree, rolls.back() / units::degree,
              roll.start_of_active_profile / units::degree, roll.tip / units::degree));
    if (z.front() > low + rounding || z.back() < high - rounding)
      throw InputError(
          file.place(key) +
          fmt::format("the table covers z from {:.4f} to {:.4f} mm, contact needs {:.4f} to {:.4f} mm",
                      z.front(), z.back(), low, high));
    return std::make_shared<Topography>(name, std::move(rolls), std::move(z), std::move(removed));
  }
} // namespace flank
