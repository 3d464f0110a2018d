// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/study/study_work.hpp"

namespace flank
{
  /// A study whose variants share nothing: each is a piece of its own.
  class SeparateVariants : public StudyWork
  {
  public:
    /// The axes must outlive the object.
    explicit SeparateVariants(const StudyAxes &axes);

    void enumerate() override;
    std::shared_ptr<const VariantFrame> frame(long variant) const override;
    std::string refusal(long variant) const override;
    int n_stages() const override { return 1; }
    const std::vector<StudyPiece> &pieces(int stage) const override;
    void prepare(int, const ParallelSession &) override {}
    double bytes() const override;
    double bytes_of_process(int processes) const override;
    std::vector<StudyOutcome> solve(const StudyPiece &piece) const override;

  protected:
    /// Loads and positions of a variant's case. Throws InputError.
    virtual VariantFrame frame_of(const CaseFile &file) const = 0;

    /// What one thread takes for a variant. Throws InputError. [bytes]
    virtual double bytes_of(const CaseFile &file) const = 0;

    /// All positions at all loads. Throws ComputationError where no load has results.
    virtual StudyOutcome outcome_of(const CaseFile &file) const = 0;

    /// point(position, load) of all; a load that throws a ComputationError at one position fails, alone.
    static StudyOutcome each_load(std::size_t positions, std::size_t loads,
                                  const std::function<StudyPoint(std::size_t, std::size_t)> &point);

    const StudyAxes &axes_;

  private:
    std::vector<std::shared_ptr<const VariantFrame>> frames_;
    std::vector<StudyPiece> pieces_;
    double most_bytes_ = 0; ///< of a variant
  };
} // namespace flank
