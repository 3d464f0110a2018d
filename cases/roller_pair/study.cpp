// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/study.hpp"

#include "cases/roller_pair/plan.hpp"
#include "cases/roller_pair/results.hpp"
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
    class RollerPairStudy : public StudyWork
    {
    public:
      explicit RollerPairStudy(const StudyAxes &axes)
          : axes_(axes)
      {
      }

      StudyColumns columns() const override
      {
        return { .abscissa = "contact",
                 .load = "force",
                 .load_unit = "N",
                 .value = "approach",
                 .stiffness = "stiffness",
                 .over_positions = false };
      }

      void enumerate() override
      {
        frames_.resize(axes_.n_variants());
        for (long v = 0; v < axes_.n_variants(); ++v)
          if (refusal(v).empty())
            {
              VariantFrame frame;
              frame.torques_Nm = read(v).forces;
              frame.abscissa = { 0 };
              frames_[v] = std::make_shared<const VariantFrame>(std::move(frame));
              pieces_.push_back({ { v }, { 0 } });
            }
      }

      double bytes() const override
      {
        return static_cast<double>(axes_.n_variants()) *
               (200.0 + static_cast<double>(read(0).forces.size() * sizeof(StudyPoint)));
      }

      std::shared_ptr<const VariantFrame> frame(const long variant) const override
      {
        return frames_[variant];
      }
      std::string refusal(const long variant) const override
      {
        try
          {
            read(variant);
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
        try
          {
            const RollerPairCase input = read(piece.variants.front());
            StudyOutcome outcome;
            for (const double force : input.forces)
              {
                const RollerPairContact at = press(input.rollers, input.grid, force);
                const double slope = at.stiffness > 0 ? 1 / at.stiffness / units::micrometre : 0; // [um/N]
                outcome.points.push_back({ .te_um = at.approach / units::micrometre,
                                           .te_slope = slope,
                                           .max_pressure = at.max_pressure,
                                           .edge_pressure = at.edge_pressure,
                                           .stiffness = at.stiffness / units::newton_per_micrometre,
                                           .certificate = at.certificate.worst(),
                                           .contacts = force > 0 });
              }
            return { std::move(outcome) };
          }
        catch (const ComputationError &error)
          {
            return { { .failure = error.what(), .points = {} } };
          }
      }

      std::string plan(const int processes) override
      {
        const RollerPairCase first = read(0);
        const double all = static_cast<double>(axes_.n_variants());
        const double workers = std::max(1.0, std::min<double>(processes * available_threads(), all));
        return fmt::format("Will be computed\n  {:.6g} contacts, as many forces for every variant as for the "
                           "first one\nLeft out\n  pressure "
                           "maps and subsurface stresses: flank run of one variant has them\nExpected: "
                           "{:.3g} operations, {:.2g} s on this "
                           "machine by {} processes of {} threads; {:.2g} GB\n",
                           all * static_cast<double>(first.forces.size()), all * operations(first),
                           all * operations(first) / operations_a_second() / workers, processes,
                           available_threads(), 1e-9 * (bytes_needed(first) + bytes()));
      }

    private:
      RollerPairCase read(const long variant) const { return read_roller_pair(axes_.variant(variant)); }

      const StudyAxes &axes_;
      std::vector<std::shared_ptr<const VariantFrame>> frames_;
      std::vector<StudyPiece> pieces_;
    };
  } // namespace

  std::unique_ptr<StudyWork> roller_pair_study(const StudyAxes &axes)
  {
    return std::make_unique<RollerPairStudy>(axes);
  }
} // namespace flank
