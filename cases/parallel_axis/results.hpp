// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair/extra.hpp"
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "cases/work/result_folder.hpp"

namespace flank
{
  /// The text that stands on the screen and in summary.txt.
  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results,
                      const std::vector<ExtraOutput> &extras);

  /// Writes te.csv, harmonics.csv, pairs.csv, lines.csv, pattern.csv, the tables of extras, results.h5 and
  /// case.toml; sidebands.csv where there are several mesh cycles, design_torques.csv and
  /// amplitudes_over_torque.csv where several torques are loaded, modifications.csv where a flank has any;
  /// summary.txt is the last.
  void write_results(const ResultFolder &folder, const CaseFile &file, const ParallelAxisCase &input,
                     const ParallelAxisResults &results, const std::vector<ExtraOutput> &extras,
                     const std::string &versions);

  /// Writes results.h5: positions, contact cells, maps, what the summary says of each torque, the stages'
  /// times, which alone differ where results are equal. Each of `tables` becomes a group.
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input,
                  const ParallelAxisResults &results, const std::vector<ContactPattern> &patterns,
                  const std::vector<ResultTable> &tables, const std::string &versions);
} // namespace flank
