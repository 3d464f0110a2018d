// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/separate_variants.hpp"

#include "cases/study/study_axes.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"

#include <algorithm>
#include <numeric>

namespace flank
{
  SeparateVariants::SeparateVariants(const StudyAxes &axes)
      : axes_(axes)
  {
  }

  void SeparateVariants::enumerate()
  {
    frames_.resize(axes_.n_variants());
    for (long v = 0; v < axes_.n_variants(); ++v)
      try
        {
          const CaseFile file = axes_.variant(v);
          frames_[v] = std::make_shared<const VariantFrame>(frame_of(file));
          most_bytes_ = std::max(most_bytes_, bytes_of(file));
          StudyPiece piece{ .variants = { v }, .positions = std::vector<int>(frames_[v]->abscissa.size()) };
          std::iota(piece.positions.begin(), piece.positions.end(), 0);
          pieces_.push_back(std::move(piece));
        }
      catch (const InputError &)
        {
        }
  }

  double SeparateVariants::bytes() const
  {
    const auto frame = axes_.of_first_taken([&](const CaseFile &file) { return frame_of(file); });
    const double points = frame ? 1.0 * frame->abscissa.size() * frame->loads.size() : 0;
    return static_cast<double>(axes_.n_variants()) * (200 + points * sizeof(StudyPoint));
  }

  double SeparateVariants::bytes_of_process(int) const
  {
    return most_bytes_ * available_threads();
  }

  std::shared_ptr<const VariantFrame> SeparateVariants::frame(const long variant) const
  {
    return frames_[variant];
  }

  std::string SeparateVariants::refusal(const long variant) const
  {
    try
      {
        frame_of(axes_.variant(variant));
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return {};
  }

  const std::vector<StudyPiece> &SeparateVariants::pieces(int) const
  {
    return pieces_;
  }

  std::vector<StudyOutcome> SeparateVariants::solve(const StudyPiece &piece) const
  {
    std::vector<StudyOutcome> outcomes;
    for (const long variant : piece.variants)
      try
        {
          outcomes.push_back(outcome_of(axes_.variant(variant)));
        }
      catch (const ComputationError &error)
        {
          outcomes.push_back({ .failure = error.what() });
        }
    return outcomes;
  }

  StudyOutcome SeparateVariants::each_load(const std::size_t positions, const std::size_t loads,
                                           const std::function<StudyPoint(std::size_t, std::size_t)> &point)
  {
    StudyOutcome outcome{ .points = std::vector<StudyPoint>(positions * loads) };
    std::vector<std::string> failures(loads);
    for (std::size_t k = 0; k < positions; ++k)
      for (std::size_t t = 0; t < loads; ++t)
        try
          {
            if (failures[t].empty())
              outcome.points[k * loads + t] = point(k, t);
          }
        catch (const ComputationError &error)
          {
            failures[t] = error.what();
          }
    if (!std::ranges::all_of(failures, &std::string::empty))
      outcome.failures = std::move(failures);
    return outcome;
  }
} // namespace flank
