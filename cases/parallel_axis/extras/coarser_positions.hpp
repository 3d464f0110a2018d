// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/extra.hpp"

#include <functional>
#include <map>
#include <vector>

namespace flank
{
  /// Places at or halfway between positions, counted in half steps, each with the numbers of the torques that
  /// ask for it; none for runs over several mesh cycles. places(number of a torque): which it asks for, known
  /// on rank 0, from -1 on and each as often as may be. Known on every rank. Collective.
  std::map<int, std::vector<int>> halves_wanted(const FinishedRun &run,
                                                const std::function<std::vector<int>(std::size_t)> &places);

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
