// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/study.hpp"

#include "cases/double_roller/results.hpp"
#include "cases/study/separate_variants.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    class DoubleRollerStudy : public SeparateVariants
    {
    public:
      using SeparateVariants::SeparateVariants;

      StudyColumns columns() const override
      {
        return { .abscissa = "crank_angle_deg", .abscissa_unit = "deg" };
      }

      std::string plan(const int processes) override
      {
        constexpr long most_looked_at =
            200; // then the variants are counted as those, spread over all, that are
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
        return fmt::format("Will be computed\n  {:.6g} load {}\nLeft out\n  finite elements, there are "
                           "none in this scene; pairs, pressure maps: "
                           "flank run of one variant has them\nExpected on this machine, {} of {}\n  "
                           "{} s; {} GB a process\n",
                           solves, noun_for(solves, "balance"), counted(processes, "process", "processes"),
                           counted(available_threads(), "thread"),
                           two_digits(start_seconds::drive_or_study + seconds / static_cast<double>(workers)),
                           two_digits(0.2 + 1e-9 * bytes()));
      }

    protected:
      VariantFrame frame_of(const CaseFile &file) const override
      {
        return flank::frame_of(read_double_roller(file));
      }

      double bytes_of(const CaseFile &file) const override { return bytes_needed(read_double_roller(file)); }

      StudyOutcome outcome_of(const CaseFile &file) const override
      {
        const DoubleRollerCase input = read_double_roller(file);
        const LoadedDrive drive(input);
        return each_load(input.crank_angles.size(), input.torques.size(),
                         [&](const std::size_t k, const std::size_t t) {
                           return study_point(input, drive.solve(input.crank_angles[k], input.torques[t]));
                         });
      }
    };
  } // namespace

  std::unique_ptr<StudyWork> double_roller_study(const StudyAxes &axes)
  {
    return std::make_unique<DoubleRollerStudy>(axes);
  }
} // namespace flank
