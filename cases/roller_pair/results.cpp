// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/results.hpp"

#include "cases/results/hdf5_file.hpp"
#include "cases/results/hdf5_head.hpp"
#include "cases/results/result_table.hpp"
#include "contact/rollers/roller_ends.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <variant>

namespace flank
{
  namespace
  {
    const char *roller_pair_conventions =
        "# approach: of the rollers' axes under the force. stiffness: tangent, d force / d approach.\n"
        "# max_pressure: mean over a cell, away from the rollers' ends, before it rises towards ends that "
        "the "
        "contact reaches;\n# edge_pressure: at the ends; it depends on the grid, but for free ends of power "
        "0. "
        "end_power: at free ends the pressure goes as the distance to this power (0: finite), "
        "end_intensity times it where it is singular.\n# width, "
        "length: of the loaded cells.\n# Subsurface: half-space under the actual pressures, below "
        "max_pressure; "
        "half the difference of the outer principal stresses, von Mises; depths from the surface.\n"
        "# hertz_: closed form for smooth bodies without ends (Hertz 1882; Johnson 1985, 3.2 and 4.2), its "
        "stresses below the middle; empty where there is none.\n";

    using units::micrometre, units::newton_per_micrometre;

    /// One list: the columns, then the same numbers of every force.
    /// `ends`: null where the half-space goes on.
    ResultTable contact_table(const std::vector<RollerPairResult> &results, const RollerEnds *ends)
    {
      const std::string format = "{:.9g}";
      ResultTable table("contact", roller_pair_conventions,
                        { { "force_N", "N", format },
                          { "approach_um", "um", format },
                          { "stiffness_N_per_um", "N/um", format },
                          { "max_pressure_MPa", "MPa", format },
                          { "edge_pressure_MPa", "MPa", format },
                          { "end_power", "1", "{:.6f}" },
                          { "end_intensity_MPa_mm", "MPa mm^-end_power", format },
                          { "width_mm", "mm", format },
                          { "length_mm", "mm", format },
                          { "shear_MPa", "MPa", format },
                          { "shear_depth_um", "um", format },
                          { "von_mises_MPa", "MPa", format },
                          { "von_mises_depth_um", "um", format },
                          { "hertz_approach_um", "um", format },
                          { "hertz_stiffness_N_per_um", "N/um", format },
                          { "hertz_max_pressure_MPa", "MPa", format },
                          { "hertz_width_mm", "mm", format },
                          { "hertz_length_mm", "mm", format },
                          { "hertz_shear_MPa", "MPa", format },
                          { "hertz_shear_depth_um", "um", format },
                          { "hertz_von_mises_MPa", "MPa", format },
                          { "hertz_von_mises_depth_um", "um", format },
                          { "certificate", "relative", "{:.3e}" } });
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      const double power = ends ? ends->pressure_exponent() : none;
      for (const RollerPairResult &r : results)
        {
          const RollerPairContact &c = r.contact;
          const auto &ellipse = r.reference.ellipse;
          const auto &line = r.reference.line;
          const auto &below = r.reference.subsurface;
          table.add({ r.force,
                      c.approach / micrometre,
                      c.stiffness / newton_per_micrometre,
                      c.max_pressure,
                      c.edge_pressure,
                      power,
                      power < 0 ? c.end_intensity : none,
                      c.width,
                      c.length,
                      r.subsurface.shear,
                      r.subsurface.shear_depth / micrometre,
                      r.subsurface.von_mises,
                      r.subsurface.von_mises_depth / micrometre,
                      ellipse ? ellipse->approach / micrometre : none,
                      ellipse ? ellipse->stiffness / newton_per_micrometre : none,
                      ellipse ? ellipse->max_pressure
                      : line  ? line->max_pressure
                              : none,
                      ellipse ? 2 * ellipse->short_half_axis
                      : line  ? 2 * line->half_width
                              : none,
                      ellipse ? 2 * ellipse->long_half_axis : none,
                      below ? below->shear : none,
                      below ? below->shear_depth / micrometre : none,
                      below ? below->von_mises : none,
                      below ? below->von_mises_depth / micrometre : none,
                      c.certificate.worst() });
        }
      return table;
    }

    void write_hdf5(const std::string &path, const CaseFile &file, const RollerPairCase &input,
                    const std::vector<RollerPairResult> &results, const ResultTable &table,
                    const std::vector<std::pair<std::string, double>> &stages, const std::string &versions)
    {
      Hdf5File out;
      write_head(out, { input.title, file.source(), file.resolved(), versions, roller_pair_conventions });
      table.write(out);
      stage_table(stages).write(out);
      for (std::size_t k = 0; k < results.size(); ++k)
        {
          const std::vector<PressedCell> &cells = results[k].contact.cells;
          const auto member = [&](const char *name, const char *unit, double PressedCell::*value) {
            std::vector<double> values;
            for (const PressedCell &cell : cells)
              values.push_back(cell.*value);
            if (!cells.empty())
              out.dataset(fmt::format("pressure_maps/force_{}", k), name, { values.size() }, values, unit);
          };
          member("x", "mm", &PressedCell::x);
          member("y", "mm", &PressedCell::y);
          member("half_x", "mm", &PressedCell::half_x);
          member("half_y", "mm", &PressedCell::half_y);
          member("pressure", "MPa", &PressedCell::pressure);
        }
      out.write_to(path);
    }
  } // namespace

  RollerPairRun run_roller_pair(const RollerPairCase &input)
  {
    std::vector<std::variant<RollerPairResult, std::string>> each(input.forces.size());
    parallel_for(static_cast<int>(each.size()), [&](const int k) {
      const double force = input.forces[k];
      try
        {
          RollerPairContact contact = press(input.rollers, input.grid, force);
          const auto below = below_greatest_pressure(input.rollers, contact);
          each[k] = RollerPairResult{ .force = force,
                                      .contact = std::move(contact),
                                      .subsurface = below,
                                      .reference = hertz(input.rollers, force) };
        }
      catch (const ComputationError &error)
        {
          each[k] = std::string(error.what());
        }
    });
    RollerPairRun run;
    for (std::size_t k = 0; k < each.size(); ++k)
      if (auto *result = std::get_if<RollerPairResult>(&each[k]))
        run.results.push_back(std::move(*result));
      else
        run.failures.push_back(
            fmt::format("{:.6g} N has no results: {}", input.forces[k], std::get<std::string>(each[k])));
    if (run.results.empty())
      throw ComputationError(std::get<std::string>(each.front()));
    return run;
  }

  namespace
  {
    /// What the pressures at free ends are.
    std::string end_line(const RollerPairCase &input, const RollerPairRun &run)
    {
      const double power = input.rollers.free_ends->pressure_exponent();
      if (power == 0)
        return "pressure at the free ends: finite, both rollers end there\n";
      std::string line =
          fmt::format("pressure at the free ends: singular, the longer roller goes on; it goes as the "
                      "distance to the power {:.3f}, times",
                      power);
      for (const RollerPairResult &r : run.results)
        line += fmt::format(" {:.5g}", r.contact.end_intensity);
      return line + fmt::format(" MPa mm^{:.3f}\n", -power);
    }
  } // namespace

  std::string summary(const RollerPairCase &input, const RollerPairRun &run)
  {
    std::string text =
        fmt::format("{}\n{:>12} {:>12} {:>14} {:>14} {:>12} {:>12} {:>12} {:>14} {:>12} {:>12}\n",
                    input.title, "force N", "approach um", "stiffness N/um", "pressure MPa", "at ends MPa",
                    "shear MPa", "Hertz: um", "N/um", "MPa", "shear MPa");
    const auto shown = [](const auto &reference, const auto &value) {
      return reference ? fmt::format("{:.6g}", value(*reference)) : std::string("-");
    };
    double worst = 0;
    for (const RollerPairResult &r : run.results)
      {
        const auto &e = r.reference.ellipse;
        const auto &l = r.reference.line;
        text += fmt::format(
            "{:>12.6g} {:>12.6g} {:>14.6g} {:>14.6g} {:>12.6g} {:>12.6g} {:>12} {:>14} {:>12} {:>12}\n",
            r.force, r.contact.approach / micrometre, r.contact.stiffness / newton_per_micrometre,
            r.contact.max_pressure, r.contact.edge_pressure, r.subsurface.shear,
            shown(e, [](const auto &of) { return of.approach / micrometre; }),
            shown(e, [](const auto &of) { return of.stiffness / newton_per_micrometre; }),
            l ? shown(l, [](const auto &of) { return of.max_pressure; })
              : shown(e, [](const auto &of) { return of.max_pressure; }),
            shown(r.reference.subsurface, [](const auto &of) { return of.shear; }));
        worst = std::max(worst, r.contact.certificate.worst());
      }
    text += fmt::format("certificate: worst relative violation {:.2e}\n", worst);
    if (input.rollers.free_ends)
      text += end_line(input, run);
    for (const std::string &failure : run.failures)
      text += "failed: " + failure + "\n";
    return text + roller_pair_conventions;
  }

  void write_results(const ResultFolder &folder, const CaseFile &file, const RollerPairCase &input,
                     const RollerPairRun &run, const std::vector<std::pair<std::string, double>> &stages,
                     const std::string &versions)
  {
    const ResultTable table = contact_table(run.results, input.rollers.free_ends.get());
    folder.write("results.h5", [&](const std::string &path) {
      write_hdf5(path, file, input, run.results, table, stages, versions);
    });
    table.write(folder);
    folder.write("case.toml", file.source_with_settings());
    folder.write("summary.txt", summary(input, run));
  }
} // namespace flank
