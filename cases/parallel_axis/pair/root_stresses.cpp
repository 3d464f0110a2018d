// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/root_stresses.hpp"

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "cases/work/packing.hpp"
#include "contact/stress/body_field.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace flank
{
  namespace
  {
    /// A torque at a position that this rank looks after.
    struct LoadedPosition
    {
      int torque, position;
      std::array<TeethLoads, 2> loads; ///< of the pinion, of the gear
    };

    /// The ranks take the positions in turn.
    std::vector<LoadedPosition> own_positions(const ParallelAxisCase &input, const PositionsOfTorques &at,
                                              LoadedBodies &bodies, const SharedWork &work)
    {
      std::vector<LoadedPosition> own;
      for (int position = work.rank(); position < input.positions; position += work.ranks())
        for (std::size_t t = 0; t < input.torques.size(); ++t)
          if (input.torques[t] > 0)
            {
              LoadedPosition &added = own.emplace_back(LoadedPosition{ static_cast<int>(t), position, {} });
              for (const Side side : { Side::pinion, Side::gear })
                added.loads[side == Side::gear] =
                    flank_loads(bodies.bodies()[bodies.of(side)]->far_field().surface,
                                at[t][static_cast<std::size_t>(position)], side);
            }
      return own;
    }

    /// Adds the stresses of both fillets of every loaded tooth of one body.
    void add_stresses(const ParallelAxisCase &input, LoadedBodies &bodies,
                      const std::vector<LoadedPosition> &own, const Side side,
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
      const BodyElements &elements = bodies.bodies()[bodies.of(side)]->elements();
      const FlankSurface surface = flank_surface(elements.sector());
      const LoadedTeeth &inside = bodies.inside(bodies.of(side));
      const FilletStress &fillets = bodies.fillets(bodies.of(side));
      const CutDisplacements cuts = inside.cuts(loads, { teeth.begin(), teeth.end() });
      for (std::size_t c = 0; c < own.size(); ++c)
        {
          const Placement placement = placement_of(input.pair, side, 1.0 * own[c].position / input.positions);
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
  } // namespace

  std::vector<RootStress> root_stresses(const ParallelAxisCase &input, const PositionsOfTorques &at,
                                        LoadedBodies &bodies, const SharedWork &work)
  {
    const std::vector<LoadedPosition> positions = own_positions(input, at, bodies, work);
    std::vector<RootStress> own;
    for (const Side side : { Side::pinion, Side::gear })
      add_stresses(input, bodies, positions, side, own);
    return gathered(own, work);
  }

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

  std::vector<double> greatest_root_stresses(LoadedBodies &bodies, const Side side,
                                             const std::vector<ToothPairsAt> &of)
  {
    const std::size_t body = bodies.of(side);
    const auto tooth_of = [side](const int pair) { return side == Side::pinion ? pair : -pair; };
    std::vector<TeethLoads> loads;
    std::set<int> teeth;
    for (const auto &[position, pairs] : of)
      {
        loads.push_back(flank_loads(bodies.bodies()[body]->far_field().surface, *position, side));
        for (const int pair : pairs)
          teeth.insert(tooth_of(pair));
      }
    const LoadedTeeth &inside = bodies.inside(body);
    const CutDisplacements cuts = inside.cuts(loads, { teeth.begin(), teeth.end() });
    std::vector<double> greatest(of.size(), 0.0);
    for (std::size_t c = 0; c < of.size(); ++c)
      for (const int pair : of[c].pairs)
        for (const std::vector<double> &fillet : bodies.fillets(body).greatest(
                 inside.displacement(loads[c], tooth_of(pair), cuts[c].at(tooth_of(pair)))))
          for (const double stress : fillet)
            greatest[c] = std::max(greatest[c], stress);
    return greatest;
  }
} // namespace flank
