// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/root_stress_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    /// The greatest root stress of a body at every position of a torque. [MPa]
    std::vector<double> of_positions(const FinishedRun &run, const std::size_t torque, const Side side)
    {
      std::vector<double> greatest(static_cast<std::size_t>(run.input.positions), 0.0);
      for (const RootStress &root : run.root_stresses)
        if (root.torque == static_cast<int>(torque) && root.body == (side == Side::gear))
          {
            double &of_position = greatest[static_cast<std::size_t>(root.position)];
            of_position = std::max(of_position, root.stress);
          }
      return greatest;
    }

    /// By how much coarser bodies see the greatest stress otherwise, relative.
    double by_elements(const FinishedRun &run, const RootStress &greatest, LoadedBodies &coarser)
    {
      const PositionResult &position =
          run.at[static_cast<std::size_t>(greatest.torque)][static_cast<std::size_t>(greatest.position)];
      const double coarse = greatest_root_stress(coarser, greatest.body == 0 ? Side::pinion : Side::gear,
                                                 position, { greatest.pair });
      return std::abs(coarse / greatest.stress - 1);
    }

    /// How much more may hide between the positions, relative.
    double by_positions(const FinishedRun &run, const RootStress &greatest, const Halves &halves)
    {
      const Side side = greatest.body == 0 ? Side::pinion : Side::gear;
      PointsOfPeriod halfway;
      for (const auto &[place, half] :
           beside({ greatest.position }, halves, static_cast<std::size_t>(run.input.positions)))
        {
          std::vector<int> pairs;
          for (const PairLoad &load : half.pairs)
            pairs.push_back(load.pair);
          halfway[place] = greatest_root_stress(run.bodies, side, half, pairs);
        }
      return hidden_between(of_positions(run, static_cast<std::size_t>(greatest.torque), side),
                            run.input.positions, halfway);
    }
  } // namespace

  std::vector<int> peaks_of_root_stress(const FinishedRun &run, const std::size_t torque)
  {
    std::vector<int> peaks;
    const auto most = greatest_of(run.input, run.root_stresses);
    for (const RootStress *greatest : most[torque])
      if (greatest)
        peaks.push_back(greatest->position);
    return peaks;
  }

  std::array<double, 2> root_stress_errors(const FinishedRun &run, const std::size_t torque,
                                           const Halves &halves, LoadedBodies &coarser)
  {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 2> errors = { unknown, unknown };
    const auto most = greatest_of(run.input, run.root_stresses);
    for (const RootStress *greatest : most[torque])
      if (greatest && greatest->stress > 0)
        errors[static_cast<std::size_t>(greatest->body)] =
            by_elements(run, *greatest, coarser) + by_positions(run, *greatest, halves);
    return errors;
  }
} // namespace flank
