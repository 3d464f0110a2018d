// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scene/scene.hpp"
#include "cases/double_roller/input.hpp"
#include "cases/double_roller/keys.hpp"
#include "cases/double_roller/results.hpp"
#include "cases/double_roller/study.hpp"
#include "cases/double_roller/supports.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    /// Every process makes the laws; crank angles are shared out.
    std::string plan_report(const DoubleRollerCase &input, const int processes)
    {
      return fmt::format(
          "{} by {}: load-approach laws of the distinct pairs, then one rotation each.\n{}"
          "Supports: {}.\nLeft out: finite elements, there are none in this scene; {}.\n"
          "Expected on this machine, {} of {}: {} s; {} GB{}\n",
          counted(input.crank_angles.size(), "crank angle"), counted(input.torques.size(), "torque"),
          input.contact.free_ends
              ? "What the free ends of rollers and sleeves add, by waves along the edges of "
                "quarter-spaces, to every law.\n"
              : "",
          described(input.supports), input.pressure_maps.left_out(),
          counted(processes, "process", "processes"), counted(available_threads(), "thread"),
          two_digits(start_seconds::drive_or_study +
                     operations(input, processes) / operations_a_second() / available_threads()),
          two_digits(1e-9 * bytes_needed(input)), processes == 1 ? "" : " a process");
    }

    std::string run(const CaseFile &file, RunContext &context)
    {
      const DoubleRollerCase input = read_double_roller(file);
      for (const std::string &warning : input.warnings)
        spdlog::warn("warning: {}", warning);
      require_memory(bytes_needed(input), context.session.ranks_on_node(), "this run",
                     "lower contact_grid.cells_across, cells_along, crank angles or torques");
      return context.with_folder(file.inputs(), file.files(), [&](Journal &journal) {
        const LoadedDrive drive(input);
        const DoubleRollerResults results =
            run_double_roller(input, drive, SharedWork(&context.session, &journal));
        if (context.session.rank() > 0)
          return std::string(); // the results are on rank 0
        for (const std::string &failure : results.failures)
          spdlog::error("failed: {}", failure);
        DoubleRollerCase solved = input;
        solved.torques = results.torques;
        if (const double preload = *std::max_element(results.preload.begin(), results.preload.end());
            preload > 0)
          spdlog::warn("warning: unloaded, a pair is pressed with up to {:.2f} N by interference", preload);
        input.pressure_maps.write_fields(context.folder, solved, drive, results);
        write_results(context.folder, file, solved, drive, results, context.versions);
        context.failures = results.failures;
        context.folder.finish(results.failures);
        return summary(solved, results);
      });
    }
  } // namespace

  /// Rollers and sleeves of a cycloid type drive in rolling contact.
  Scene double_roller_scene()
  {
    return { .keys = double_roller_keys(),
             .result_files = { "pairs.csv", "unloaded.csv", "design_torques.csv",
                               "amplitudes_over_torque.csv", "shares.csv", "supports.csv", "sidebands.csv" },
             .check = [](const CaseFile &file) { return drive_report(read_double_roller(file)); },
             .plan = [](const CaseFile &file,
                        const int processes) { return plan_report(read_double_roller(file), processes); },
             .run = run,
             .study = double_roller_study };
  }
} // namespace flank
