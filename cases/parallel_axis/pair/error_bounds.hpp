// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/results/harmonics.hpp"

#include <array>
#include <map>
#include <vector>

namespace flank
{
  /// What coarser computations say of the transmission error at one torque. [um]
  struct CoarserDifferences
  {
    /// At some positions: what a coarser contact grid adds on the same bodies, and what coarser bodies add on
    /// that coarser grid.
    std::vector<double> by_grid, by_bodies;

    /// Transmission error on the coarser grid halfway from the positions of its greatest and least values to
    /// their neighbours and within steps_of_jumps(), as far as it was computed: by place, in positions.
    std::map<double, double> between;
  };

  /// Upper bounds of how far measures of a transmission error over its period are from those of ever finer
  /// bodies, grids and positions; how true they are: validation/run coverage. [um]
  struct TransmissionErrorBounds
  {
    double position = 0; ///< of the transmission error of any position
    double mean = 0;
    double mean_by_bodies = 0, mean_by_grid = 0, mean_by_positions = 0; ///< the mean's parts
    double shift = 0;       ///< what finer bodies and grids are expected to add to the mean
    double oscillation = 0; ///< root mean square about the mean
    double peak_to_peak = 0;
    std::array<double, 3> amplitude = {}; ///< of the mesh harmonics A_1 to A_3; not-a-number where the
                                          ///< positions do not show them
  };

  /// Fewer positions of a mesh cycle are no curve.
  constexpr int fewest_positions = 4;

  /// The two steps of a curve, from the position of that number to the next, that rise or fall most beyond
  /// those beside them, where a tooth pair takes or leaves its load at once; without jumps below a fiftieth
  /// of peak-to-peak. What lies halfway in them tells most of the mesh harmonics' errors.
  std::vector<int> steps_of_jumps(const std::vector<double> &te);

  /// Not-a-number throughout.
  TransmissionErrorBounds nothing_known();

  /// Fewer than four positions a mesh cycle are no curve: nothing is known then but what elements and grid
  /// make of the mean. `te`: at all positions of the period, which is `cycles` mesh cycles [um]; `spectrum`:
  /// its harmonics.
  TransmissionErrorBounds error_bounds(const std::vector<double> &te, const std::vector<Harmonic> &spectrum,
                                       int cycles, const CoarserDifferences &coarser);
} // namespace flank
