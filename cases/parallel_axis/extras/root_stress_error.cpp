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

    Side side_of(const RootStress &root)
    {
      return root.body == 0 ? Side::pinion : Side::gear;
    }

    /// By how much coarser bodies see the greatest stress otherwise, relative.
    double by_elements(const FinishedRun &run, const RootStress &greatest, LoadedBodies &coarser)
    {
      const PositionResult &position =
          run.at[static_cast<std::size_t>(greatest.torque)][static_cast<std::size_t>(greatest.position)];
      const double coarse =
          greatest_root_stresses(coarser, side_of(greatest), { { &position, greatest.pair } }).front();
      return std::abs(coarse / greatest.stress - 1);
    }

    /// The greatest stress of a body at some places under the forces of the coarser grid, over what that
    /// finds at the place of `greatest`. [MPa]
    PointsOfPeriod beside_greatest(const FinishedRun &run, const RootStress &greatest, const Halves &halves)
    {
      const double at = greatest.position;
      Halves places = beside({ greatest.position }, halves, static_cast<std::size_t>(run.input.positions));
      if (const auto here = halves.find(at); here != halves.end())
        places.insert(*here);
      std::vector<LoadedTeethAt> loaded;
      for (const auto &[place, half] : places)
        loaded.push_back({ &half });
      PointsOfPeriod found;
      const std::vector<double> stresses = greatest_root_stresses(run.bodies, side_of(greatest), loaded);
      std::size_t i = 0;
      for (const auto &[place, half] : places)
        found[place] = stresses[i++];
      const double over_coarser = found.contains(at) ? greatest.stress / found[at] : 1; // of the grids
      found.erase(at);
      for (auto &[place, stress] : found)
        stress *= over_coarser;
      return found;
    }

    /// How much more may hide between the positions, relative.
    double by_positions(const FinishedRun &run, const RootStress &greatest, const Halves &halves)
    {
      return hidden_between(of_positions(run, static_cast<std::size_t>(greatest.torque), side_of(greatest)),
                            run.input.positions, beside_greatest(run, greatest, halves));
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
