// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/input/topography_file.hpp"

#include "mesh/base/counted.hpp"
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
    /// Without the blanks around it, and then without one pair of quotes.
    std::string bare(std::string cell)
    {
      constexpr const char *blanks = " \t\r";
      cell.erase(0, std::min(cell.find_first_not_of(blanks), cell.size()));
      cell.erase(cell.find_last_not_of(blanks) + 1);
      const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
      return quoted ? cell.substr(1, cell.size() - 2) : cell;
    }

    std::vector<std::string> split(const std::string &line)
    {
      // Commas inside parentheses belong to the first cell.
      std::vector<std::string> cells(1);
      int depth = 0;
      for (const char c : line)
        {
          depth += c == '(' ? 1 : c == ')' ? -1 : 0;
          if (c == ',' && depth == 0)
            cells.emplace_back();
          else
            cells.back() += c;
        }
      std::ranges::transform(cells, cells.begin(), bare);
      return cells;
    }

    /// The lines of a table: face positions in the first, a roll angle and what is removed in each other one.
    class TableReader
    {
    public:
      TableReader(const CaseFile &file, const std::string &key, const Gear &gear)
          : file_(file)
          , key_(key)
          , path_((std::filesystem::path(file.file()).parent_path() / file.text(key)).string())
          , base_radius_(gear.base_radius)
      {
        std::istringstream stream(file.text_of_file(key));
        std::string line;
        for (number_ = 1; std::getline(stream, line); ++number_)
          if (!line.empty() && line[0] != '#' && line != "\r")
            {
              cells_ = split(line);
              if (header_.empty())
                read_header();
              else
                read_row();
            }
        if (rows.size() < 2)
          throw InputError(file.place(key) +
                           fmt::format("{} needs a first line and at least two rows", path_));
        require_apart(rolls, "rows");
        require_apart(z, "face positions");
      }

      std::vector<double> rolls, z;          ///< [rad, mm], ascending
      std::vector<std::vector<double>> rows; ///< [mm]

    private:
      [[noreturn]] void refuse(const std::string &what) const
      {
        throw InputError(
            fmt::format("{}:{}: {} (table of {}, {})", path_, number_, what, key_, file_.file()));
      }

      /// Closer ones are one place to the interpolation's numbers.
      void require_apart(const std::vector<double> &places, const char *what) const
      {
        const double least = 1e-6 * (places.back() - places.front());
        for (std::size_t k = 1; k < places.size(); ++k)
          if (!(places[k] - places[k - 1] >= least))
            throw InputError(file_.place(key_) +
                             fmt::format("{}: {} {} and {} are closer than a millionth of the table's range",
                                         path_, what, k, k + 1));
      }

      double value(const std::size_t column) const
      {
        const std::string &cell = cells_[column];
        double v = 0;
        const char *from = cell.c_str() + (cell.starts_with('+') ? 1 : 0);
        const auto read = std::from_chars(from, cell.data() + cell.size(), v);
        if (cell.empty() || !std::isfinite(v))
          refuse(fmt::format("a hole in column {}; every place needs a number", column + 1));
        if (read.ec != std::errc() || read.ptr != cell.data() + cell.size())
          refuse(fmt::format("column {}: \"{}\" is not a number", column + 1, cell));
        return v;
      }

      void read_header()
      {
        header_ = cells_[0];
        std::erase_if(header_, [](const char c) { return c == ' ' || c == '\t'; });
        if (header_ != "removed_um(roll_angle_deg,z_mm)" && header_ != "removed_um(diameter_mm,z_mm)" &&
            header_ != "removed_um(length_of_roll_mm,z_mm)")
          refuse("the first cell must say quantity, axes and units: removed_um(roll_angle_deg,z_mm), "
                 "removed_um(diameter_mm,z_mm) or "
                 "removed_um(length_of_roll_mm,z_mm)"); // what it is instead may be a foreign file's
        for (std::size_t c = 1; c < cells_.size(); ++c)
          z.push_back(value(c));
        if (z.size() < 2)
          refuse("at least two face positions are needed");
        if (!std::is_sorted(z.begin(), z.end(), std::less_equal<>()))
          refuse("the face positions must ascend");
      }

      double roll_of(const double first) const
      {
        if (header_.find("diameter") == std::string::npos)
          return header_.find("length") != std::string::npos ? first / base_radius_ : first * units::degree;
        if (first / 2 < base_radius_)
          refuse(
              fmt::format("diameter {} mm lies below the base circle, {:.4f} mm", first, 2 * base_radius_));
        return roll_angle(first / 2, base_radius_);
      }

      void read_row()
      {
        if (cells_.size() != z.size() + 1)
          refuse(fmt::format("{} after the first, the first line has {}",
                             counted(cells_.size() - 1, "number"), counted(z.size(), "face position")));
        rolls.push_back(roll_of(value(0)));
        if (rolls.size() > 1 && rolls.back() <= rolls[rolls.size() - 2])
          refuse("the first column must ascend");
        rows.emplace_back();
        for (std::size_t c = 1; c < cells_.size(); ++c)
          {
            rows.back().push_back(value(c) * units::micrometre);
            if (std::abs(rows.back().back()) > 10)
              refuse(fmt::format("column {}: {} um is more than 10 mm; are these micrometres?", c + 1,
                                 cells_[c]));
          }
      }

      const CaseFile &file_;
      const std::string &key_;
      std::string path_;
      double base_radius_;
      std::string header_;
      std::vector<std::string> cells_;
      int number_ = 0;
    };

    /// The active profile and the common face must be covered.
    void require_cover(const CaseFile &file, const std::string &key, const std::vector<double> &rolls,
                       const std::vector<double> &z, const RollAngles &roll, const double low,
                       const double high)
    {
      constexpr double rounding = 1e-4; // deg and mm: tables are printed with few digits
      if (rolls.front() > roll.start_of_active_profile + rounding * units::degree ||
          rolls.back() < roll.tip - rounding * units::degree)
        throw InputError(
            file.place(key) +
            fmt::format("the table covers roll angles {:.4f} to {:.4f} deg, the active profile is {:.4f} to "
                        "{:.4f} deg",
                        rolls.front() / units::degree, rolls.back() / units::degree,
                        roll.start_of_active_profile / units::degree, roll.tip / units::degree));
      if (z.front() > low + rounding || z.back() < high - rounding)
        throw InputError(
            file.place(key) +
            fmt::format("the table covers z from {:.4f} to {:.4f} mm, contact needs {:.4f} to {:.4f} mm",
                        z.front(), z.back(), low, high));
    }
  } // namespace

  std::shared_ptr<const Topography> read_topography(const CaseFile &file, const std::string &key,
                                                    const GearPair &pair, const Gear &gear,
                                                    const RollAngles &roll, const bool mirrored)
  {
    TableReader table(file, key, gear);
    std::vector<double> &z = table.z;
    Eigen::MatrixXd removed(table.rows.size(), z.size());
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      for (std::size_t j = 0; j < z.size(); ++j)
        removed(i, j) = table.rows[i][j];
    if (mirrored)
      {
        std::reverse(z.begin(), z.end());
        for (double &v : z)
          v = -v;
        removed = removed.rowwise().reverse().eval();
      }
    const double offset = gear.name == "gear" ? pair.data.axial_offset : 0;
    require_cover(file, key, table.rolls, z, roll, pair.face_low - offset, pair.face_high - offset);
    return std::make_shared<Topography>(file.text(key), std::move(table.rolls), std::move(z),
                                        std::move(removed), gear.base_radius);
  }
} // namespace flank
