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
    struct OwnPosition
    {
      int torque, position;
    };

    /// The ranks take the positions in turn.
    std::vector<OwnPosition> positions_of_rank(const ParallelAxisCase &input, const SharedWork &work)
    {
      std::vector<OwnPosition> own;
      for (int position = work.rank(); position < input.positions; position += work.ranks())
        for (std::size_t t = 0; t < input.torques.size(); ++t)
          if (input.torques[t] > 0)
            own.push_back({ static_cast<int>(t), position });
      return own;
    }

    /// take(number among `of`, pair, stress) of every tooth that is meant.
    template <class Take>
    void each_tooth(LoadedBodies &bodies, const Side side, const std::vector<LoadedTeethAt> &of,
                    const Take &take)
    {
      if (of.empty())
        return;
      const std::size_t body = bodies.of(side);
      const auto pair_of = [side](const int tooth) { return side == Side::pinion ? tooth : -tooth; };
      std::vector<TeethLoads> loads;
      std::set<int> teeth;
      for (const auto &[position, pair] : of)
        {
          loads.push_back(flank_loads(bodies.bodies()[body]->far_field().surface, *position, side));
          for (const auto &[tooth, load] : loads.back())
            if (!pair || *pair == pair_of(tooth))
              teeth.insert(tooth);
        }
      const LoadedTeeth &inside = bodies.inside(body);
      const FilletStress &fillets = bodies.fillets(body);
      const CutDisplacements cuts = inside.cuts(loads, { teeth.begin(), teeth.end() });
      for (std::size_t c = 0; c < of.size(); ++c)
        for (const auto &[tooth, load] : loads[c])
          if (!of[c].pair || *of[c].pair == pair_of(tooth))
            take(c, pair_of(tooth),
                 fillets.greatest(inside.displacement(loads[c], tooth, cuts[c].at(tooth))));
    }

    /// Adds the stresses of both fillets of every loaded tooth of one body.
    void add_stresses(const ParallelAxisCase &input, const PositionsOfTorques &at, LoadedBodies &bodies,
                      const std::vector<OwnPosition> &own, const Side side, std::vector<RootStress> &result)
    {
      std::vector<LoadedTeethAt> of;
      for (const auto &[torque, position] : own)
        of.push_back({ &at[static_cast<std::size_t>(torque)][static_cast<std::size_t>(position)] });
      const FlankSurface surface = flank_surface(bodies.bodies()[bodies.of(side)]->elements().sector());
      each_tooth(bodies, side, of, [&](const std::size_t c, const int pair, const auto &stress) {
        const Placement placement = placement_of(input.pair, side, 1.0 * own[c].position / input.positions);
        for (const int fillet : { 0, 1 })
          for (std::size_t n = 0; n < stress[fillet].size(); ++n)
            result.push_back({ .torque = own[c].torque,
                               .position = own[c].position,
                               .body = side == Side::gear,
                               .pair = pair,
                               .other_side = fillet,
                               .z = placement.point({ 0, 0, surface.z_at(static_cast<int>(n)) }).z(),
                               .stress = stress[fillet][n] });
      });
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
    const std::vector<OwnPosition> positions = positions_of_rank(input, work);
    std::vector<RootStress> own;
    for (const Side side : { Side::pinion, Side::gear })
      add_stresses(input, at, bodies, positions, side, own);
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
                                             const std::vector<LoadedTeethAt> &of)
  {
    std::vector<double> greatest(of.size(), 0.0);
    each_tooth(bodies, side, of, [&](const std::size_t c, int, const auto &stress) {
      for (const std::vector<double> &fillet : stress)
        for (const double value : fillet)
          greatest[c] = std::max(greatest[c], value);
    });
    return greatest;
  }
} // namespace flank
