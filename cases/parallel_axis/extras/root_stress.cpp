// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "cases/parallel_axis/pair/root_stresses.hpp"
#include "contact/matching/body_size.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace flank
{
  namespace
  {
    /// Time of the stress in one tooth's fillets over that of the whole tooth's fields. Fitted by the case
    /// "helical, root stress" of validation/run plan.
    constexpr double of_a_field = 0.55;

    int loaded_torques(const ParallelAxisCase &input)
    {
      return static_cast<int>(
          std::count_if(input.torques.begin(), input.torques.end(), [](const double t) { return t > 0; }));
    }

    /// ISO 6336-3's beside ours: a line with its factors.
    std::string nominal_root_stress(const GearPair &pair, const double torque)
    {
      const auto stress = iso_6336_nominal_root_stress(pair, torque);
      const auto pinion = iso_6336_root_stress(pair, pair.pinion),
                 gear = iso_6336_root_stress(pair, pair.gear);
      return fmt::format(" ISO 6336-3 method B nominal, all load factors 1: pinion {:.1f} MPa (Y_F {:.3f}, "
                         "Y_S {:.3f}, Y_beta {:.3f}), gear "
                         "{:.1f} MPa (Y_F {:.3f}, Y_S {:.3f})\n",
                         stress[0], pinion.form_factor, pinion.stress_correction, pinion.helix_factor,
                         stress[1], gear.form_factor, gear.stress_correction);
    }

    std::string summary_of(const ParallelAxisCase &input, const std::vector<RootStress> &roots)
    {
      std::string lines;
      const auto greatest = greatest_of(input, roots);
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const auto &most = greatest[t];
          if (most[0] && most[1])
            lines += fmt::format("greatest tensile root stress at {:.6g} N m: pinion {:.1f} MPa at z = "
                                 "{:.3f} mm, gear {:.1f} MPa at z = {:.3f} mm\n",
                                 input.torques[t] / units::newton_metre, most[0]->stress, most[0]->z,
                                 most[1]->stress, most[1]->z) +
                     nominal_root_stress(input.pair, input.torques[t]);
        }
      return lines;
    }

    ResultTable table_of(const ParallelAxisCase &input, const std::vector<RootStress> &roots,
                         const std::vector<ErrorsOfTorque> &errors)
    {
      std::string heading = conventions;
      for (const double torque : input.torques)
        if (torque > 0)
          heading += fmt::format("# at {:.6g} N m", torque / units::newton_metre) +
                     nominal_root_stress(input.pair, torque);
      heading += "# greatest principal stress over the arc of a fillet, tension positive, of finer "
                 "elements over it; loaded: below the loaded flank\n"
                 "# tensile_stress_bound_MPa: upper bound of the error of the greatest of a body and torque, "
                 "in its row; nan: not estimated\n";
      ResultTable table("root_stress", heading,
                        { torque_column(),
                          position_column(),
                          phase_column(),
                          { "body", "", "{}", { "pinion", "gear" } },
                          { "pair", "1", "{}" },
                          { "fillet", "", "{}", { "loaded", "other" } },
                          { "z_mm", "mm", "{:.6f}" },
                          { "tensile_stress_MPa", "MPa", "{:.4f}" },
                          bound_column("tensile_stress_bound_MPa", "MPa", "{:.4f}") });
      const auto most = greatest_of(input, roots);
      for (const RootStress &r : roots)
        table.add({ input.torques[r.torque] / units::newton_metre, 1.0 * r.position,
                    1.0 * r.position / input.positions, 1.0 * r.body, 1.0 * r.pair, 1.0 * r.other_side, r.z,
                    r.stress,
                    !errors.empty() && most[r.torque][r.body] == &r
                        ? errors[r.torque].root_stress[r.body] * r.stress
                        : ErrorsOfTorque::unknown });
      return table;
    }

    class RootStressOfTeeth : public Extra
    {
    public:
      std::string name() const override { return root_stress_name; }

      void keep(const ParallelAxisCase &input, Kept &kept) const override
      {
        for (int position = 0; position < input.positions; ++position)
          kept.cells.insert(position);
      }

      ExtraPlan plan(const ParallelAxisCase &input) const override
      {
        return { .computed = { fmt::format("root stress: both fillets of every loaded tooth at {} positions "
                                           "by {}, a tooth sector condensed and factored anew",
                                           input.positions, counted(loaded_torques(input), "torque")) },
                 .left_out = {} };
      }

      ExtraCost cost(const ParallelAxisCase &input, const int processes) const override
      {
        const double cases = 1.0 * input.positions * loaded_torques(input), // of load
            teeth = input.pair.total_contact_ratio() + 0.5;
        double fillets = 0, cuts = 0; // bytes; the cuts of all teeth that are loaded anywhere in the cycle
        for (const BodyDefinition &body : input.bodies())
          {
            fillets += fillets_bytes(body.resolution);
            cuts = std::max(cuts, 8 * size_of(body.resolution).cut * cases / processes * (teeth + 2));
          }
        constexpr double cell_bytes = 400; // of a contact cell with its outlines, kept for every grid
        const double cells = teeth * input.grid.slices * input.grid.profile_cells * input.positions *
                             static_cast<double>(torque_bands(input.pair, input.torques).size());
        return { .inside_bodies = true,
                 .sector_solutions = of_a_field * cases * teeth,
                 .gigabytes_inside = 1e-9 * (fillets + cuts + cell_bytes * cells) };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        if (run.work.rank() != 0)
          return {};
        return { .summary = summary_of(run.input, run.root_stresses),
                 .table = table_of(run.input, run.root_stresses, run.errors) };
      }
    };
  } // namespace

  ExtraKind root_stress()
  {
    ExtraKind kind = on_request(
        root_stress_name, "output.root_stress",
        "greatest tensile stress in both fillets of every loaded tooth, along the face, over the first mesh "
        "cycle",
        "root_stress.csv", "stress in the fillets",
        [](const CaseFile &, const ParallelAxisCase &) { return std::make_shared<RootStressOfTeeth>(); });
    kind.of_loaded_teeth = "output.root_stress";
    return kind;
  }
} // namespace flank
