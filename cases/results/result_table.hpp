// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace flank
{
  class Hdf5File;
  class ResultFolder;

  /// A table of results, declared once: a CSV file and a group of results.h5 with the same columns.
  class ResultTable
  {
  public:
    struct Column
    {
      std::string name;                    ///< with its unit, as the head of the CSV file has it: "torque_Nm"
      std::string unit;                    ///< of the data set
      std::string format;                  ///< of the CSV file: "{:.6f}"; "{}" for whole numbers
      std::vector<std::string> words = {}; ///< that its numbers 0, 1, ... stand for, where it is of words
      std::string missing = {};            ///< what the CSV file says where there is no value

      bool is_whole() const { return format == "{}"; }
    };

    /// Whether the file's first column is that of the variant, 0.
    enum class Variant
    {
      with,
      without
    };

    /// `name`: of the file, without .csv, and of the group; `heading`: lines that begin with #.
    ResultTable(std::string name, std::string heading, std::vector<Column> columns,
                Variant variant = Variant::with);

    /// A value a column. NaN: there is none.
    void add(const std::vector<double> &row);

    /// A table of several variants with these columns behind the variant's number; no rows yet.
    ResultTable of_variants(std::string name) const;

    /// All rows of a table of one variant, whose columns are these but the first.
    void add(long variant, const ResultTable &rows);

    bool empty() const { return values_.front().empty(); }

    void write(const ResultFolder &folder) const;
    void write(Hdf5File &file) const;

    /// The text of the CSV file.
    std::string csv() const;

  private:
    std::string name_, heading_;
    std::vector<Column> columns_;
    Variant variant_;
    std::vector<std::vector<double>> values_; ///< of each column
  };

  /// The columns that most tables begin with.
  ResultTable::Column torque_column();
  ResultTable::Column position_column();
  ResultTable::Column phase_column();

  /// Names and wall times [s] of a run's stages, for results.h5. The one thing in it that differs from run to
  /// run.
  ResultTable stage_table(const std::vector<std::pair<std::string, double>> &stages);

  /// harmonics.csv without rows: torque, number, amplitude, phase, whether it is aliased.
  ResultTable empty_harmonic_table(const std::string &heading);
} // namespace flank
