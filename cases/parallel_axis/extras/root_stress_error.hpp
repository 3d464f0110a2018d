// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/extras/between_positions.hpp"
#include "cases/parallel_axis/pair/extra.hpp"

#include <array>
#include <vector>

namespace flank
{
  /// The positions of the greatest root stress of each body at a torque, by its number; none where none is.
  /// Of rank 0.
  std::vector<int> peaks_of_root_stress(const FinishedRun &run, std::size_t torque);

  /// Upper bounds of the errors of the greatest root stress at a torque, relative: of the pinion, of the
  /// gear; not-a-number where no tooth is loaded. By how much coarser bodies see the stress of that tooth
  /// otherwise under the same contact forces, and what may hide between positions: `halves`, with their
  /// cells, are of the torque, and one at the greatest's own place. Of rank 0. Throws ComputationError.
  std::array<double, 2> root_stress_errors(const FinishedRun &run, std::size_t torque, const Halves &halves,
                                           LoadedBodies &coarser);
} // namespace flank
