// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/results.hpp"

#include "cases/results/hdf5_file.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    const char *conventions = "# approach: of the rollers' axes under the force. stiffness: tangent, d force "
                              "/ d approach. max_pressure: mean over a cell, away from "
                              "the rollers' ends;\n# edge_pressure: at their ends, where no half-space is: "
                              "it depends on the grid. width, length: of the loaded "
                              "cells. Subsurface: half-space under the actual\n# pressures, below the "
                              "greatest one; half the difference of the outer principal "
                              "stresses, von Mises; depths from the surface. hertz_: closed form for "
                              "smooth\n# bodies without ends (Hertz 1882; Johnson 1985, 3.2 "
                              "and 4.2), empty where there is none.\n";

    /// A quantity of a result: its name and unit in tables, its value, which Hertz's reference may not have.
    struct Column
    {
      const char *name, *unit;
      double (*value)(const RollerPairResult &);
      bool (*is_there)(const RollerPairResult &) = nullptr; ///< null: always
    };

    bool has_ellipse(const RollerPairResult &r)
    {
      return r.reference.ellipse.has_value();
    }

    bool has_any(const RollerPairResult &r)
    {
      return r.reference.ellipse || r.reference.line;
    }

    using units::micrometre, units::newton_per_micrometre;
    using Result = const RollerPairResult &;

    /// What contact.csv and results.h5 hold beside the force, in their order.
    const Column columns[] = {
      { "approach", "um", [](Result r) { return r.contact.approach / micrometre; } },
      { "stiffness", "N/um", [](Result r) { return r.contact.stiffness / newton_per_micrometre; } },
      { "max_pressure", "MPa", [](Result r) { return r.contact.max_pressure; } },
      { "edge_pressure", "MPa", [](Result r) { return r.contact.edge_pressure; } },
      { "width", "mm", [](Result r) { return r.contact.width; } },
      { "length", "mm", [](Result r) { return r.contact.length; } },
      { "shear", "MPa", [](Result r) { return r.contact.subsurface.shear; } },
      { "shear_depth", "um", [](Result r) { return r.contact.subsurface.shear_depth / micrometre; } },
      { "von_mises", "MPa", [](Result r) { return r.contact.subsurface.von_mises; } },
      { "von_mises_depth", "um", [](Result r) { return r.contact.subsurface.von_mises_depth / micrometre; } },
      { "hertz_approach", "um", [](Result r) { return r.reference.ellipse->approach / micrometre; },
        has_ellipse },
      { "hertz_stiffness", "N/um",
        [](Result r) { return r.reference.ellipse->stiffness / newton_per_micrometre; }, has_ellipse },
      { "hertz_max_pressure", "MPa",
        [](Result r) {
          return r.reference.ellipse ? r.reference.ellipse->max_pressure : r.reference.line->max_pressure;
        },
        has_any },
      { "hertz_width", "mm",
        [](Result r) {
          return 2 *
                 (r.reference.ellipse ? r.reference.ellipse->short_half_axis : r.reference.line->half_width);
        },
        has_any },
      { "hertz_length", "mm", [](Result r) { return 2 * r.reference.ellipse->long_half_axis; }, has_ellipse },
    };

    std::string unit_in_name(std::string unit)
    {
      if (const auto slash = unit.find('/'); slash != std::string::npos)
        unit.replace(slash, 1, "_per_");
      return unit;
    }

    bool is_there(const Column &column, const RollerPairResult &result)
    {
      return !column.is_there || column.is_there(result);
    }

    std::string table(const std::vector<RollerPairResult> &results)
    {
      std::string text = std::string(conventions) + "variant,force_N";
      for (const Column &column : columns)
        text += fmt::format(",{}_{}", column.name, unit_in_name(column.unit));
      text += ",certificate\n";
      for (const RollerPairResult &result : results)
        {
          text += fmt::format("0,{:.9g}", result.force);
          for (const Column &column : columns)
            text += is_there(column, result) ? fmt::format(",{:.9g}", column.value(result)) : ",";
          text += fmt::format(",{:.3e}\n", result.contact.certificate.worst());
        }
      return text;
    }

    void write_hdf5(const std::string &path, const CaseFile &file, const RollerPairCase &input,
                    const std::vector<RollerPairResult> &results, const std::string &versions)
    {
      Hdf5File out;
      out.attribute("title", input.title);
      out.attribute("case_as_given", file.source());
      out.attribute("case_as_resolved", file.resolved());
      out.attribute("versions", versions);
      out.attribute("conventions", conventions);
      out.dataset("", "force", { input.forces.size() }, input.forces, "N");
      for (const Column &column : columns)
        if (std::all_of(results.begin(), results.end(), [&](Result r) { return is_there(column, r); }))
          {
            std::vector<double> values;
            for (const RollerPairResult &result : results)
              values.push_back(column.value(result));
            out.dataset("", column.name, { values.size() }, values, column.unit, { "force" });
          }
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

  std::vector<RollerPairResult> run_roller_pair(const RollerPairCase &input)
  {
    std::vector<RollerPairResult> results(input.forces.size());
    parallel_for(static_cast<int>(results.size()), [&](const int k) {
      const double force = input.forces[k];
      results[k] = { force, press(input.rollers, input.grid, force), hertz(input.rollers, force) };
    });
    return results;
  }

  std::string summary(const RollerPairCase &input, const std::vector<RollerPairResult> &results)
  {
    std::string text = fmt::format("{}\n{:>12} {:>12} {:>14} {:>14} {:>12} {:>12} {:>14} {:>12}\n",
                                   input.title, "force N", "approach um", "stiffness N/um", "pressure MPa",
                                   "at ends MPa", "Hertz: um", "N/um", "MPa");
    double worst = 0;
    for (const RollerPairResult &r : results)
      {
        const auto &e = r.reference.ellipse;
        const auto &l = r.reference.line;
        text +=
            fmt::format("{:>12.6g} {:>12.6g} {:>14.6g} {:>14.6g} {:>12.6g} {:>12} {:>14} {:>12}\n", r.force,
                        r.contact.approach / micrometre, r.contact.stiffness / newton_per_micrometre,
                        r.contact.max_pressure, r.contact.edge_pressure,
                        e ? fmt::format("{:.6g}", e->approach / micrometre) : "-",
                        e ? fmt::format("{:.6g}", e->stiffness / newton_per_micrometre) : "-",
                        e   ? fmt::format("{:.6g}", e->max_pressure)
                        : l ? fmt::format("{:.6g}", l->max_pressure)
                            : "-");
        worst = std::max(worst, r.contact.certificate.worst());
      }
    return text + fmt::format("certificate: worst relative violation {:.2e}\n", worst) + conventions;
  }

  void write_results(const ResultFolder &folder, const CaseFile &file, const RollerPairCase &input,
                     const std::vector<RollerPairResult> &results, const std::string &versions)
  {
    folder.write("results.h5",
                 [&](const std::string &path) { write_hdf5(path, file, input, results, versions); });
    folder.write("contact.csv", table(results));
    folder.write("case.toml", file.source());
    folder.write("summary.txt", summary(input, results));
  }
} // namespace flank
