// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/results/design_bounds.hpp"
#include "cases/results/result_table.hpp"
#include "cases/results/variant.hpp"
#include "cases/work/journal.hpp"
#include "mesh/base/errors.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace flank
{
  class ParallelSession;
  class ResultFolder;
  class StudyAxes;

  /// What the tables of a study call its quantities.
  struct StudyColumns
  {
    const char *abscissa;                     ///< of the positions, with its unit
    const char *abscissa_unit;                ///< of the data set
    const char *load = "torque";              ///< what a variant is computed over
    const char *load_unit = "N m";            ///< of StudyPoint::response_slope's denominator too
    const char *value = "te";                 ///< of StudyPoint::response
    const char *stiffness = "mesh_stiffness"; ///< of StudyPoint::stiffness
    bool has_bounds = false;                  ///< designs.csv has bounds, where they are estimated
    bool over_positions = true; ///< false: there is one position, and neither harmonics nor design torques,
                                ///< nor a table over positions

    /// The head of a column of loads: "torque_Nm".
    std::string load_head() const
    {
      std::string unit = load_unit;
      std::erase(unit, ' ');
      return std::string(load) + "_" + unit;
    }
  };

  /// Some positions of some variants, done in one go: they share what they have in common.
  struct StudyPiece
  {
    std::vector<long> variants;
    std::vector<int> positions;
  };

  /// One variant's part of a piece.
  struct StudyOutcome
  {
    std::string failure = {};            ///< why there are no results; empty where there are
    std::vector<StudyPoint> points = {}; ///< [position of the piece][load]

    std::vector<double> derivatives = {}; ///< [position of the piece][load][parameter] of the response [um
                                          ///< over the key's unit]

    /// [load]: why it has no results, its points and derivatives then mean nothing; empty where it has. No
    /// entries: all loads have results.
    std::vector<std::string> failures = {};

    std::vector<Journal::Record> records = {}; ///< for beyond_tables(), which finds them in its journal
  };

  /// What a study has beside the tables of all variants: tables of its first variant, and those that the case
  /// asks for of every variant.
  struct BeyondTables
  {
    std::vector<ResultTable> tables;                  ///< files beside designs.csv, and groups of study.h5
    std::map<long, std::vector<DesignBounds>> bounds; ///< of variants: a load each, but those without results
    std::string summary;                              ///< lines
    std::string failure;                              ///< why it could not be computed; empty where it could
  };

  /// A case that is of runs alone: no study of it is computed. Exit code 2.
  struct StudyRefused : InputError
  {
    using InputError::InputError;
  };

  /// A study as one kind of drive does it: stages one after the other (what one needs in memory is gone
  /// before the next), pieces of a stage in any order on any rank and thread.
  class StudyWork
  {
  public:
    virtual ~StudyWork() = default;

    virtual StudyColumns columns() const = 0;

    /// Looks at every variant. To be called before everything else but plan() and bytes().
    virtual void enumerate() = 0;

    /// Memory of the tables of all variants, judged by the first one that is not refused. [bytes]
    virtual double bytes() const = 0;

    /// Memory that a process takes beside the tables, on all its threads, for the variants that need most;
    /// after enumerate(). [bytes]
    virtual double bytes_of_process(int processes) const = 0;

    /// Loads and positions of a variant; null where its input is refused: refusal() says why.
    virtual std::shared_ptr<const VariantFrame> frame(long variant) const = 0;
    virtual std::string refusal(long variant) const = 0;

    /// Paths of all files that the variants name.
    virtual std::vector<std::string> files() const { return {}; }

    virtual int n_stages() const = 0;
    virtual const std::vector<StudyPiece> &pieces(int stage) const = 0;

    /// Makes ready what the pieces of a stage share. Collective.
    virtual void prepare(int stage, const ParallelSession &session) = 0;

    /// Results for the piece's variants in their order. Safe to use from several threads.
    virtual std::vector<StudyOutcome> solve(const StudyPiece &piece) const = 0;

    /// What the case asks for beyond every variant's tables, of the first variant (or of every one where it
    /// says so); on rank 0 alone, after all pieces and the last call of solve(). It does not throw: without
    /// it the tables are whole.
    virtual BeyondTables beyond_tables(Journal &, const ResultFolder &,
                                       const std::function<bool(long)> & /*has_failed*/)
    {
      return {};
    }

    /// What will be computed, what is left out and why, time and memory.
    virtual std::string plan(int processes) = 0;
  };
} // namespace flank
