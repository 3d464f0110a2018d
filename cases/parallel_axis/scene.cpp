// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scene.hpp"

#include "cases/parallel_axis/geometry_report.hpp"
#include "cases/parallel_axis/results.hpp"

#include <spdlog/spdlog.h>

namespace flank
{
  Scene parallel_axis_scene()
  {
    return { "parallel_axis", [](const CaseFile &file) { return geometry_report(read_parallel_axis(file)); },
             [](const CaseFile &file, const ResultFolder &folder, const std::string &versions) {
               const ParallelAxisCase input = read_parallel_axis(file);
               for (const std::string &warning : input.pair.warnings)
                 spdlog::warn("warning: {}", warning);
               folder.begin();
               const ParallelAxisResults results = run_parallel_axis(input);
               write_results(folder, file, input, results, versions);
               return summary(input, results);
             } };
  }
} // namespace flank
