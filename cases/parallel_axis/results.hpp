// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/mesh_cycle.hpp"

namespace flank
{
  /// What stands on the screen and in summary.txt.
  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results);

  /// Writes te.csv, harmonics.csv, pairs.csv, results.h5, summary.txt and case.toml under `folder`, each complete or not at all.
  void write_results(const std::string &folder, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results, const std::string &versions);

  /// HDF5 part of it (deal.II's wrapper).
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results, const std::string &versions);
} // namespace flank
