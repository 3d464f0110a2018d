// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/study/study_axes.hpp"
#include "cases/study/study_work.hpp"
#include "cases/work/result_folder.hpp"

namespace flank
{
  class Hdf5File;
  class TableFile;

  /// What te.csv and designs.csv begin with.
  inline constexpr const char *study_conventions =
      "# TE and signs as in te.csv of a single run. A_i: peak amplitude of mesh harmonic i. T_d: all local "
      "minima over torque inside the computed range, by the\n# cubic through values and exact slopes of the "
      "TE at every position; torques in N m, parted by semicolons. Pressures: greatest over the cycle.\n";

  /// All variants of a study in their order, put together piece by piece.
  class StudyTable
  {
  public:
    StudyTable(const StudyAxes &axes, const StudyWork &work);

    /// Adds what a piece has found of a variant at some positions.
    void add(long variant, const std::vector<int> &positions, StudyOutcome outcome);

    /// After all pieces: the variants have the loads that have results at all positions.
    void leave_out_failed_loads();

    /// Variants without a result, those that lack a load, and computed ones whose positions hold no whole
    /// period.
    long failed() const;
    long without_loads() const;
    long without_period() const;
    /// The first ten variants or loads without a result and how many more there are, a line each, and what
    /// could not be computed beyond the tables.
    std::vector<std::string> failures(const BeyondTables &beyond) const;
    bool has_failed(const long variant) const { return !variants_[variant].failure.empty(); }

    /// Writes designs.csv, te.csv (where there are several positions), the first variant's tables, study.h5
    /// and case.toml, summary.txt last; returns the summary.
    std::string write(const ResultFolder &folder, const CaseFile &file, const BeyondTables &beyond,
                      const std::string &versions) const;

  private:
    struct FailedLoad
    {
      double load; ///< in its unit
      std::string why;
    };
    struct Variant
    {
      std::shared_ptr<const VariantFrame> frame;
      std::string failure;
      std::vector<StudyPoint> points;    ///< [position][load]
      std::vector<double> derivatives;   ///< [position][load][parameter]
      std::vector<std::string> failures; ///< [load], as StudyOutcome's
      std::vector<FailedLoad> left_out;  ///< of the frame that it had
    };
    std::string head_of_row(std::size_t variant) const;
    void write_failures(TableFile &stream, std::size_t variant, std::size_t columns) const;
    void write_designs(const std::string &path,
                       const std::map<long, std::vector<DesignBounds>> &bounds) const;
    void write_design(TableFile &stream, std::size_t variant, const std::vector<DesignBounds> &bounds) const;
    void write_designs_of_one_position(TableFile &stream) const;
    std::string derivatives(const Variant &variant, std::size_t torque) const;
    void write_te(const std::string &path) const;
    std::vector<int> on_frame_of(std::size_t first) const;
    void write_block(Hdf5File &h5, const std::string &folder, const std::vector<int> &numbers) const;
    void write_hdf5(const std::string &path, const CaseFile &file, const std::vector<ResultTable> &tables,
                    const std::string &versions) const;

    const StudyAxes &axes_;
    const StudyWork &work_;
    std::vector<Variant> variants_;
    std::vector<std::string> parameters_; ///< of all variants
  };
} // namespace flank
