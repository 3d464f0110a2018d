// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/study.hpp"

#include "cases/double_roller/results.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    class DoubleRollerStudy : public StudyWork
    {
    public:
      explicit DoubleRollerStudy(const StudyAxes &axes)
          : axes_(axes)
      {
      }

      void enumerate() override
      {
        frames_.resize(axes_.n_variants());
        for (std::size_t v = 0; v < frames_.size(); ++v)
          if (refusal(static_cast<long>(v)).empty())
            {
              const DoubleRollerCase input = read_double_roller(axes_.variant(static_cast<long>(v)));
              frames_[v] = std::make_shared<const VariantFrame>(frame_of(input));
              StudyPiece piece{ { static_cast<long>(v) }, {} };
              for (std::size_t k = 0; k < input.crank_angles.size(); ++k)
                piece.positions.push_back(static_cast<int>(k));
              pieces_.push_back(std::move(piece));
            }
      }

      double bytes() const override
      {
        const DoubleRollerCase input = read_double_roller(axes_.variant(0));
        return static_cast<double>(axes_.n_variants()) *
               (200 +
                static_cast<double>(input.crank_angles.size() * input.torques.size() * sizeof(StudyPoint)));
      }

      StudyColumns columns() const override { return { .abscissa = "crank_angle_deg" }; }

      std::shared_ptr<const VariantFrame> frame(const long variant) const override
      {
        return frames_[variant];
      }
      std::string refusal(const long variant) const override
      {
        try
          {
            read_double_roller(axes_.variant(variant));
          }
        catch (const InputError &error)
          {
            return error.what();
          }
        return {};
      }

      int n_stages() const override { return 1; }
      const std::vector<StudyPiece> &pieces(int) const override { return pieces_; }
      void prepare(int, const ParallelSession &) override {}

      std::vector<StudyOutcome> solve(const StudyPiece &piece) const override
      {
        std::vector<StudyOutcome> outcomes;
        for (const long variant : piece.variants)
          try
            {
              const DoubleRollerCase input = read_double_roller(axes_.variant(variant));
              const LoadedDrive drive(input);
              std::vector<StudyPoint> points;
              for (const double angle : input.crank_angles)
                for (const double torque : input.torques)
                  points.push_back(study_point(input, drive.solve(angle, torque)));
              for (StudyPoint &point : points)
                point.certificate = std::max(point.certificate, drive.laws().worst_certificate());
              outcomes.push_back({ {}, std::move(points), {} });
            }
          catch (const ComputationError &error)
            {
              outcomes.push_back({ error.what(), {}, {} });
            }
        return outcomes;
      }

      std::string plan(const int processes) override
      {
        constexpr long most_looked_at =
            1000; // then the variants are counted as those, spread over all, that are
        const long all = axes_.n_variants(), looked_at = std::min(all, most_looked_at);
        const double speed = operations_a_second();
        double seconds = 0, solves = 0;
        for (long k = 0; k < looked_at; ++k)
          try
            {
              const DoubleRollerCase input = read_double_roller(axes_.variant(k * (all / looked_at)));
              seconds +=
                  operations(input) / speed * static_cast<double>(all) / static_cast<double>(looked_at);
              solves += static_cast<double>(input.crank_angles.size() * input.torques.size() * all) /
                        static_cast<double>(looked_at);
            }
          catch (const InputError &)
            {
            }
        const long workers = std::max(1L, std::min<long>(processes * available_threads(), all));
        return fmt::format("Will be computed\n  {:.6g} load balances\nLeft out\n  finite elements, there are "
                           "none in this scene; pairs, pressure maps: "
                           "flank run of one variant has them\nExpected on this machine, {} of {} threads\n  "
                           "{:.2g} s; {:.2g} GB a process\n",
                           solves, processes == 1 ? "one process" : fmt::format("{} processes", processes),
                           available_threads(), 0.4 + seconds / static_cast<double>(workers),
                           0.2 + 1e-9 * bytes());
      }

    private:
      const StudyAxes &axes_;
      std::vector<std::shared_ptr<const VariantFrame>> frames_;
      std::vector<StudyPiece> pieces_;
    };
  } // namespace

  std::unique_ptr<StudyWork> double_roller_study(const StudyAxes &axes)
  {
    return std::make_unique<DoubleRollerStudy>(axes);
  }
} // namespace flank
