// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

namespace flank
{
  struct Harmonic
  {
    double amplitude; ///< A_i = 2|c_i|: peak amplitude, unit of the values
    double phase;     ///< of A_i cos(2 pi i t + phase), t = 0 .. 1 over the cycle [rad]
  };

  /// Whether so few positions in a period show a harmonic >= 1 of it together with a higher one that is not
  /// surely smaller: fewer than four a wave.
  inline bool is_aliased(const int harmonic, const int positions)
  {
    return 4 * harmonic > positions;
  }

  /// The greatest less the least of values, of which there is one at least.
  double peak_to_peak(const std::vector<double> &values);

  /// Derivative of the amplitude of one harmonic by a parameter; `derivatives`: those of the values by it.
  /// Infinite slopes at zero amplitude are left out (0).
  double amplitude_derivative(const std::vector<double> &values, const std::vector<double> &derivatives,
                              int harmonic);

  /// Peak amplitude of one harmonic >= 1; not-a-number beyond n/2, which n values do not show.
  double harmonic_amplitude(const std::vector<double> &values, int harmonic);

  /// Mesh harmonics 1 .. n/2 of n equidistant values over one cycle (the first at its start, the end left
  /// out).
  std::vector<Harmonic> harmonics(const std::vector<double> &values);

  /// Mesh harmonics: every `cycles`-th line of the spectrum over the whole period.
  std::vector<Harmonic> mesh_harmonics(const std::vector<Harmonic> &spectrum, int cycles);
} // namespace flank
