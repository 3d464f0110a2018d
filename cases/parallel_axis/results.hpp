// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/input.hpp"

#include <string>
#include <utility>
#include <vector>

namespace flank
{
  /// Everything one run found: at[torque][position].
  struct ParallelAxisResults
  {
    std::vector<std::vector<PositionResult>>    at;
    std::vector<std::pair<std::string, double>> stage_seconds;
    int                                         unknowns_pinion = 0, unknowns_gear = 0;
  };

  /// Transmission error along the transverse line of action. [um]
  double transmission_error_um(const GearPair &pair, const PositionResult &result);

  /// Tangent mesh stiffness d(T/r_b)/d eps. [N/um]
  double mesh_stiffness(const GearPair &pair, const PositionResult &result);

  struct Harmonic
  {
    double amplitude; ///< A_i = 2|c_i|, peak amplitude [um]
    double phase;     ///< of cos(2 pi i phase_of_cycle + phase) [rad]
  };

  /// Harmonics 1 .. n/2 of one cycle of equidistant values.
  std::vector<Harmonic> harmonics(const std::vector<double> &values);

  ParallelAxisResults run_parallel_axis(const ParallelAxisCase &input);

  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results);

  /// Writes te.csv, harmonics.csv, pairs.csv, results.h5, summary.txt and case.toml under `folder`, each complete or not at all.
  void write_results(const std::string &folder, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results, const std::string &versions);

  /// HDF5 part of it (deal.II's wrapper).
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results, const std::string &versions);
} // namespace flank
