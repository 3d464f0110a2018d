// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/extra.hpp"

#include <functional>
#include <map>
#include <vector>

namespace flank
{
  /// Places at or halfway beside the positions where something is greatest or least at a torque, which
  /// peaks(number of the torque) tells on rank 0, counted in half steps, each with the numbers of the torques
  /// that ask for it; none for runs over several mesh cycles. `sides`: which of them, in half steps from a
  /// peak. Known on every rank. Collective.
  std::map<int, std::vector<int>> halves_of_peaks(const FinishedRun &run,
                                                  const std::function<std::vector<int>(std::size_t)> &peaks,
                                                  const std::vector<int> &sides);

  /// One coarser computation: a phase, on which bodies, for which torques.
  struct CoarseJob
  {
    double phase;             ///< in mesh cycles
    bool coarse_bodies;       ///< else those of the run
    std::vector<int> torques; ///< their numbers
    bool keep_cells = false;  ///< whether the results keep the contact's cells
  };

  /// Results [job][torque] on rank 0, of all torques [N mm]: those that a job is not for are failures, as is
  /// what is too coarse for this contact or too large for this machine. Collective.
  std::vector<std::vector<PositionResult>> solve_coarser(const std::vector<CoarseJob> &wanted,
                                                         const LoadedPair &own_bodies,
                                                         const LoadedPair &coarse_bodies,
                                                         const std::vector<double> &torques,
                                                         const SharedWork &work);
} // namespace flank
