// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/root_stress_error.hpp"

#include "contact/stress/body_field.hpp"
#include "contact/stress/fillet_stress.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Greatest principal stress in both fillets of one tooth under the contact forces of a position. [MPa]
    double greatest_root_stress(LoadedBodies &bodies, const Side side, const PositionResult &position,
                                const int pair)
    {
      const std::size_t body = bodies.of(side);
      const BodyCompliance &compliance = *bodies.bodies()[body];
      const TeethLoads loads = flank_loads(compliance.far_field().surface, position, side);
      const int tooth = side == Side::pinion ? pair : -pair;
      const LoadedTeeth &inside = bodies.inside(body);
      const CutDisplacements cuts = inside.cuts({ loads }, { tooth });
      const auto stress =
          fillet_stress(compliance.elements(), inside.displacement(loads, tooth, cuts.front().at(tooth)));
      double greatest = 0;
      for (const std::vector<double> &fillet : stress)
        for (const double value : fillet)
          greatest = std::max(greatest, value);
      return greatest;
    }
  } // namespace

  std::array<double, 2> root_stress_differences(const std::vector<PositionResult> &positions,
                                                LoadedBodies &bodies, LoadedBodies &coarser)
  {
    const PositionResult *most = nullptr;
    const PairLoad *load = nullptr;
    for (const PositionResult &position : positions)
      for (const PairLoad &of_pair : position.pairs)
        if (!load || of_pair.force > load->force)
          {
            most = &position;
            load = &of_pair;
          }
    std::array<double, 2> differences = { 0, 0 };
    if (load)
      for (const Side side : { Side::pinion, Side::gear })
        {
          const double fine = greatest_root_stress(bodies, side, *most, load->pair),
                       coarse = greatest_root_stress(coarser, side, *most, load->pair);
          differences[side == Side::gear] = fine > 0 ? std::abs(coarse / fine - 1) : 0;
        }
    return differences;
  }
} // namespace flank
