// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/study.hpp"

#include "cases/roller_pair/plan.hpp"
#include "cases/roller_pair/results.hpp"
#include "cases/study/separate_variants.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    class RollerPairStudy : public SeparateVariants
    {
    public:
      using SeparateVariants::SeparateVariants;

      StudyColumns columns() const override
      {
        return { .abscissa = "contact",
                 .abscissa_unit = "1",
                 .load = "force",
                 .load_unit = "N",
                 .value = "approach",
                 .stiffness = "stiffness",
                 .over_positions = false };
      }

      std::string plan(const int processes) override
      {
        const auto first = axes_.of_first_taken(read_roller_pair);
        if (!first)
          return "Refused as input: the first thousand variants, if not all\n";
        const double all = static_cast<double>(axes_.n_variants()),
                     contacts = all * static_cast<double>(first->forces.size());
        const double workers = std::max(1.0, std::min<double>(processes * available_threads(), all));
        return fmt::format("Will be computed\n  {:.6g} {}, as many forces for every variant as for the "
                           "first one\nLeft out\n  pressure "
                           "maps and subsurface stresses: flank run of one variant has them\nExpected: "
                           "{:.3g} operations, {} s on this "
                           "machine by {} of {}; {} GB\n",
                           contacts, noun_for(contacts, "contact"), all * operations(*first),
                           two_digits(all * operations(*first) / operations_a_second() / workers),
                           counted(processes, "process", "processes"), counted(available_threads(), "thread"),
                           two_digits(1e-9 * (bytes_needed(*first) + bytes())));
      }

    protected:
      VariantFrame frame_of(const CaseFile &file) const override
      {
        return { .loads = read_roller_pair(file).forces, .abscissa = { 0 } };
      }

      double bytes_of(const CaseFile &file) const override { return bytes_needed(read_roller_pair(file)); }

      StudyOutcome outcome_of(const CaseFile &file) const override
      {
        const RollerPairCase input = read_roller_pair(file);
        return each_load(1, input.forces.size(), [&](std::size_t, const std::size_t t) {
          const double force = input.forces[t];
          const RollerPairContact at = press(input.rollers, input.grid, force);
          const double slope = at.stiffness > 0 ? 1 / at.stiffness / units::micrometre : 0; // [um/N]
          return StudyPoint{ .response = at.approach / units::micrometre,
                             .response_slope = slope,
                             .max_pressure = at.max_pressure,
                             .edge_pressure = at.edge_pressure,
                             .stiffness = at.stiffness / units::newton_per_micrometre,
                             .certificate = at.certificate.worst(),
                             .contacts = force > 0 };
        });
      }
    };
  } // namespace

  std::unique_ptr<StudyWork> roller_pair_study(const StudyAxes &axes)
  {
    return std::make_unique<RollerPairStudy>(axes);
  }
} // namespace flank
