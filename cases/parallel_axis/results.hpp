// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/mesh_cycle.hpp"
#include "cases/results/result_folder.hpp"

namespace flank
{
  /// What stands on the screen and in summary.txt.
  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results);

  /// Writes te.csv, harmonics.csv, pairs.csv, results.h5, summary.txt and case.toml; summary.txt is the last.
  void write_results(const ResultFolder &folder, const CaseFile &file, const ParallelAxisCase &input,
                     const ParallelAxisResults &results, const std::string &versions);

  /// HDF5 part of it (deal.II's wrapper).
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input,
                  const ParallelAxisResults &results, const std::string &versions);
} // namespace flank
