// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "cases/work/packing.hpp"
#include "contact/matching/body_size.hpp"
#include "contact/stress/body_field.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

namespace flank
{
  namespace
  {
    /// Greatest tensile stress in one fillet of one loaded tooth at one place of the face.
    struct RootStress
    {
      int torque, position; ///< numbers among the case's
      int body;             ///< 0 pinion, 1 gear
      int pair;             ///< tooth pair
      int other_side;       ///< 0: the fillet below the loaded flank, 1: the other one
      double z;             ///< user's z [mm]
      double stress;        ///< greatest principal stress over the fillet, tension positive [MPa]
    };

    /// Time of the stress in one tooth's fillets over that of the whole tooth's fields. Fitted by the case
    /// "helical, root stress" of validation/run plan.
    constexpr double of_a_field = 0.55;

    /// A torque at a position that this rank looks after.
    struct LoadedPosition
    {
      int torque, position;
      std::array<TeethLoads, 2> loads; ///< of the pinion, of the gear
    };

    int loaded_torques(const ParallelAxisCase &input)
    {
      return static_cast<int>(
          std::count_if(input.torques.begin(), input.torques.end(), [](const double t) { return t > 0; }));
    }

    /// The ranks take the positions in turn.
    std::vector<LoadedPosition> own_positions(const FinishedRun &run)
    {
      std::vector<LoadedPosition> own;
      for (int position = run.work.rank(); position < run.input.positions; position += run.work.ranks())
        for (std::size_t t = 0; t < run.input.torques.size(); ++t)
          if (run.input.torques[t] > 0)
            {
              LoadedPosition &added = own.emplace_back(LoadedPosition{ static_cast<int>(t), position, {} });
              for (const Side side : { Side::pinion, Side::gear })
                added.loads[side == Side::gear] =
                    flank_loads(run.bodies.bodies()[run.bodies.of(side)]->far_field().surface,
                                run.at[t][static_cast<std::size_t>(position)], side);
            }
      return own;
    }

    /// Adds the stresses of both fillets of every loaded tooth of one body.
    void add_stresses(const FinishedRun &run, const std::vector<LoadedPosition> &own, const Side side,
                      std::vector<RootStress> &result)
    {
      std::vector<TeethLoads> loads;
      std::set<int> teeth;
      for (const LoadedPosition &position : own)
        {
          loads.push_back(position.loads[side == Side::gear]);
          for (const auto &[tooth, load] : loads.back())
            teeth.insert(tooth);
        }
      if (own.empty())
        return;
      const BodyElements &elements = run.bodies.bodies()[run.bodies.of(side)]->elements();
      const FlankSurface surface = flank_surface(elements.sector());
      const LoadedTeeth &inside = run.bodies.inside(run.bodies.of(side));
      const FilletStress &fillets = run.bodies.fillets(run.bodies.of(side));
      const CutDisplacements cuts = inside.cuts(loads, { teeth.begin(), teeth.end() });
      for (std::size_t c = 0; c < own.size(); ++c)
        {
          const Placement placement =
              placement_of(run.input.pair, side, 1.0 * own[c].position / run.input.positions);
          for (const auto &[tooth, load] : loads[c])
            {
              const auto stress = fillets.greatest(inside.displacement(loads[c], tooth, cuts[c].at(tooth)));
              for (const int fillet : { 0, 1 })
                for (std::size_t n = 0; n < stress[fillet].size(); ++n)
                  result.push_back({ .torque = own[c].torque,
                                     .position = own[c].position,
                                     .body = side == Side::gear,
                                     .pair = side == Side::pinion ? tooth : -tooth,
                                     .other_side = fillet,
                                     .z = placement.point({ 0, 0, surface.z_at(static_cast<int>(n)) }).z(),
                                     .stress = stress[fillet][n] });
            }
        }
    }

    /// The stresses of all ranks, on rank 0, in the order of the table.
    std::vector<RootStress> gathered(const std::vector<RootStress> &own, const SharedWork &work)
    {
      Packer packer;
      packer.values(own);
      std::vector<RootStress> result;
      for (const auto &of_rank : work.gather(packer.result))
        {
          Unpacker in(of_rank);
          const auto part = in.values<RootStress>();
          result.insert(result.end(), part.begin(), part.end());
        }
      std::sort(result.begin(), result.end(), [](const RootStress &a, const RootStress &b) {
        return std::tie(a.torque, a.position, a.body, a.pair, a.other_side, a.z) <
               std::tie(b.torque, b.position, b.body, b.pair, b.other_side, b.z);
      });
      return result;
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

    /// The greatest of each torque on the pinion and on the gear; null where there is none.
    std::vector<std::array<const RootStress *, 2>> greatest_of(const ParallelAxisCase &input,
                                                               const std::vector<RootStress> &roots)
    {
      std::vector<std::array<const RootStress *, 2>> most(input.torques.size());
      for (const RootStress &root : roots)
        if (const RootStress *&of_body = most[root.torque][root.body];
            !of_body || root.stress > of_body->stress)
          of_body = &root;
      return most;
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
        const std::vector<LoadedPosition> positions = own_positions(run);
        std::vector<RootStress> own;
        for (const Side side : { Side::pinion, Side::gear })
          add_stresses(run, positions, side, own);
        const std::vector<RootStress> all = gathered(own, run.work);
        if (run.work.rank() != 0)
          return {};
        return { .summary = summary_of(run.input, all), .table = table_of(run.input, all, run.errors) };
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
