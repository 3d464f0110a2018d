// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/results.hpp"
#include "cases/results/hdf5_file.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "mesh/base/units.hpp"

#include <map>

namespace flank
{
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input,
                  const ParallelAxisResults &results, const std::string &versions)
  {
    Hdf5File out;
    out.attribute("title", input.title);
    out.attribute("case_as_given", file.source());
    out.attribute("case_as_resolved", file.resolved());
    out.attribute("versions", versions);
    out.attribute("conventions",
                  "TE along the transverse line of action, positive when the driven gear lags; harmonics A_i "
                  "= 2|c_i|; z along the axis, 0 at "
                  "mid-face; roll angles sqrt((r/r_b)^2 - 1); pressures compressive positive; body " +
                      input.body.describe());
    const auto n_torques   = input.torques.size(),
               n_positions = static_cast<std::size_t>(input.positions) * input.cycles;
    std::vector<double> torques, phases;
    for (const double torque : input.torques)
      torques.push_back(torque / units::newton_metre);
    for (std::size_t k = 0; k < n_positions; ++k)
      phases.push_back(static_cast<double>(k) / input.positions);
    out.dataset("", "pinion_torque", { n_torques }, torques, "N m");
    out.dataset("", "phase", { n_positions }, phases, "mesh cycle");
    const auto table = [&](const std::string &name, const std::string &unit, const auto &value) {
      std::vector<double> values;
      for (const auto &positions : results.at)
        for (const PositionResult &p : positions)
          values.push_back(value(p));
      out.dataset("", name, { n_torques, n_positions }, values, unit);
    };
    table("transmission_error", "um", [&](const auto &p) { return transmission_error_um(input.pair, p); });
    table("mesh_stiffness", "N/um", [&](const auto &p) { return mesh_stiffness(input.pair, p); });
    table("max_pressure", "MPa", [](const auto &p) { return p.max_pressure; });
    table("max_pressure_roll_angle", "deg",
          [](const auto &p) { return p.max_pressure_roll / units::degree; });
    table("max_pressure_z", "mm", [](const auto &p) { return p.max_pressure_z; });
    table("edge_pressure", "MPa", [](const auto &p) { return p.edge_pressure; });
    table("gear_torque", "N m", [](const auto &p) { return p.gear_torque / units::newton_metre; });
    table("max_line_load", "N/mm", [](const auto &p) { return p.max_line_load; });
    table("load_centre_z", "mm", [](const auto &p) { return p.load_centre; });
    table("shuttling_moment", "N m", [](const auto &p) { return p.shuttling_moment / units::newton_metre; });
    if (input.has_tilt_springs())
      for (const auto &[axis, name] : { std::pair{ 0, "tilt_pinion_in_plane" },
                                        { 1, "tilt_pinion_across_plane" },
                                        { 2, "tilt_gear_in_plane" },
                                        { 3, "tilt_gear_across_plane" } })
        table(name, "mrad", [axis = axis](const auto &p) { return 1e3 * p.tilt[axis]; });
    table("certificate", "relative", [](const auto &p) { return p.certificate.worst(); });
    table("compliance_asymmetry", "relative", [](const auto &p) { return p.asymmetry; });
    table("contact_cells", "1", [](const auto &p) { return static_cast<double>(p.cells); });

    // The cells of a grid stand in consecutive rows, once for all torques that share it; their pressures once
    // a torque and position.
    std::map<const void *, double> row_of_grid;
    std::vector<GridCells>         grids;
    double                         rows = 0;
    std::vector<double>            first_cell, first_pressure, cells, pressure;
    for (const auto &positions : results.at)
      for (const PositionResult &p : positions)
        {
          if (const auto [it, is_new] = row_of_grid.try_emplace(p.grid_cells.get(), rows);
              is_new && p.grid_cells)
            {
              grids.push_back(p.grid_cells);
              rows += static_cast<double>(p.grid_cells->size());
            }
          first_cell.push_back(row_of_grid.at(p.grid_cells.get()));
          first_pressure.push_back(static_cast<double>(pressure.size()));
          cells.push_back(static_cast<double>(p.cell_forces.size()));
          for (std::size_t i = 0; i < p.cell_forces.size(); ++i)
            pressure.push_back(p.cell_forces[i] / (*p.grid_cells)[i].area);
        }
    out.dataset("cells", "count", { n_torques, n_positions }, cells, "cells of this torque and position");
    out.dataset("cells", "first_cell", { n_torques, n_positions }, first_cell,
                "its first row of pair, z, ... place");
    out.dataset("cells", "first_pressure", { n_torques, n_positions }, first_pressure,
                "its first row of pressure");
    out.dataset("cells", "pressure", { pressure.size() }, pressure, "MPa");
    const auto column = [&](const std::string &name, const std::string &unit, const auto &value) {
      std::vector<double> values;
      values.reserve(static_cast<std::size_t>(rows));
      for (const GridCells &grid : grids)
        for (const GridCell &cell : *grid)
          values.push_back(value(cell));
      out.dataset("cells", name, { values.size() }, values, unit);
    };
    column("pair", "1", [](const auto &c) { return static_cast<double>(c.pair); });
    column("z", "mm", [](const auto &c) { return c.z; });
    column("pinion_roll_angle", "deg", [](const auto &c) { return c.pinion_roll / units::degree; });
    column("gear_roll_angle", "deg", [](const auto &c) { return c.gear_roll / units::degree; });
    column("area", "mm^2", [](const auto &c) { return c.area; });
    column("unloaded_gap", "um", [](const auto &c) { return c.gap / units::micrometre; });
    column("place", "0 inside, 1 tip edge, 2 face end, 3 corner",
           [](const auto &c) { return static_cast<double>(c.place); });
    const auto map = [&](const std::string &group, const FlankMap &values, const std::string &unit,
                         const double scale) {
      std::vector<double> roll, all;
      for (std::size_t i = 0; i < values.roll.size(); ++i)
        {
          roll.push_back(values.roll[i] / units::degree);
          for (std::size_t j = 0; j < values.z.size(); ++j)
            all.push_back(values.value(i, j) / scale);
        }
      out.dataset(group, "roll_angle", { values.roll.size() }, roll, "deg");
      out.dataset(group, "z", { values.z.size() }, values.z, "mm");
      out.dataset(group, "value", { values.roll.size(), values.z.size() }, all, unit);
    };
    if (!input.deviations.pinion.modifications.empty() || !input.deviations.gear.modifications.empty())
      {
        map("modifications/pinion", pinion_modification(input.pair, input.deviations), "um",
            units::micrometre);
        map("modifications/gear", gear_modification(input.pair, input.deviations), "um", units::micrometre);
        map("modifications/sum", sum_of_modifications(input.pair, input.deviations), "um", units::micrometre);
      }
    const auto pattern = [&](const std::string &group, const std::vector<PositionResult> &positions) {
      const std::vector<PositionResult> cycle(positions.begin(), positions.begin() + input.positions);
      map(group, contact_pattern(input.pair, cycle, input.grid.slices), "MPa", 1);
    };
    for (std::size_t t = 0; t < n_torques; ++t)
      if (input.torques[t] > 0)
        {
          pattern("contact_pattern/torque_" + std::to_string(t), results.at[t]);
          if (input.light_load_pattern)
            pattern("contact_pattern_at_1_percent/torque_" + std::to_string(t), results.light[t]);
        }
    out.write_to(path);
  }
} // namespace flank
