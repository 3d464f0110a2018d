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
      std::vector<std::string> words = {}; ///< that the numbers 0, 1, ... stand for, in a column of words
      std::string missing = {};            ///< what the CSV file says where there is no value

      bool is_whole() const { return format == "{}"; }
    };

    /// Whether the CSV file begins with a column of the variant's number, which is 0 in all rows.
    enum class Variant
    {
      with,
      without
    };

    /// `name`: of the file, without .csv, and of the group; `heading`: lines that begin with #.
    ResultTable(std::string name, std::string heading, std::vector<Column> columns,
                Variant variant = Variant::with);

    /// Adds a row: a value a column, NaN where there is none.
    void add(const std::vector<double> &row);

    /// A table of several variants: the variant's number, then these columns. It has no rows yet.
    ResultTable of_variants(std::string name) const;

    /// Adds all rows of the table of one variant, whose columns are these but the first.
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

  /// A column of upper bounds of errors; nan in the CSV file where none is estimated.
  ResultTable::Column bound_column(const std::string &name, const std::string &unit,
                                   const std::string &format = "{:.9g}");

  /// Names and wall times [s] of a run's stages, for results.h5. The one thing in it that differs from run to
  /// run.
  ResultTable stage_table(const std::vector<std::pair<std::string, double>> &stages);

  /// Of harmonics.csv: torque, number, amplitude, phase, whether it is aliased.
  std::vector<ResultTable::Column> harmonic_columns();
} // namespace flank
