// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/pressure_kind.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/results.hpp"
#include "cases/results/hdf5_file.hpp"
#include "cases/results/hdf5_head.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"

#include <fmt/format.h>
#include <limits>
#include <map>

namespace flank
{
  namespace
  {
    std::string conventions_of(const ParallelAxisCase &input)
    {
      return "TE along the transverse line of action, positive when the driven gear lags; harmonics "
             "A_i = 2|c_i|; z along the axis, 0 at mid-face; roll angles sqrt((r/r_b)^2 - 1); pressures "
             "compressive positive; body " +
             input.body.describe();
    }

    /// The tables with one value at every torque and position, their two axes, and the lengths of the pair in
    /// a transverse section.
    void add_positions(Hdf5File &out, const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      const auto n_torques = input.torques.size(),
                 n_positions = static_cast<std::size_t>(input.positions) * input.cycles;
      std::vector<double> torques, phases;
      for (const double torque : input.torques)
        torques.push_back(torque / units::newton_metre);
      for (std::size_t k = 0; k < n_positions; ++k)
        phases.push_back(static_cast<double>(k) / input.positions);
      out.dataset("", "pinion_torque", { n_torques }, torques, "N m");
      out.dataset("", "phase", { n_positions }, phases, "mesh cycle");
      out.dataset("", "pinion_base_radius", { 1 }, std::vector{ input.pair.pinion.base_radius }, "mm");
      out.dataset("", "gear_base_radius", { 1 }, std::vector{ input.pair.gear.base_radius }, "mm");
      out.dataset("", "line_of_action", { 1 }, std::vector{ input.pair.line_of_action }, "mm");
      const auto bounds = [&](const std::string &name, const std::string &unit, const auto &value) {
        std::vector<double> values;
        for (const ErrorsOfTorque &errors : results.errors)
          for (std::size_t k = 0; k < n_positions; ++k)
            values.push_back(value(errors, k));
        if (!values.empty())
          out.dataset("", name, { n_torques, n_positions }, values, unit, { "pinion_torque", "phase" });
      };
      bounds("transmission_error_bound", "um",
             [](const auto &errors, std::size_t) { return errors.te.position; });
      bounds("max_pressure_bound", "MPa",
             [](const auto &errors, const std::size_t k) { return errors.bound_of_pressure(k); });
      const auto table = [&](const std::string &name, const std::string &unit, const auto &value) {
        std::vector<decltype(value(results.at[0][0]))> values;
        for (const auto &positions : results.at)
          for (const PositionResult &p : positions)
            values.push_back(value(p));
        out.dataset("", name, { n_torques, n_positions }, values, unit, { "pinion_torque", "phase" });
      };
      table("transmission_error", "um", [&](const auto &p) { return transmission_error_um(input.pair, p); });
      table("transmission_error_slope", "um/(N m)",
            [&](const auto &p) { return study_point(input.pair, p).response_slope; });
      table("transmission_error_rotation", "arcsec",
            [&](const auto &p) { return transmission_error_arcsec(input.pair, p); });
      table("contacts", "1", [](const auto &p) { return static_cast<int>(p.pairs.size()); });
      table("mesh_stiffness", "N/um",
            [&](const auto &p) { return tangent_stiffness(input.pair, p) / units::newton_per_micrometre; });
      table("secant_stiffness", "N/um",
            [&](const auto &p) { return secant_stiffness(input.pair, p) / units::newton_per_micrometre; });
      table("max_pressure", "MPa", [](const auto &p) { return p.max_pressure; });
      table("max_pressure_roll_angle", "deg",
            [](const auto &p) { return p.max_pressure_roll / units::degree; });
      table("max_pressure_z", "mm", [](const auto &p) { return p.max_pressure_z; });
      std::vector<int> kinds;
      for (const std::vector<PressureKind> &of_torque : pressure_kinds_of(input, results.at))
        for (const PressureKind kind : of_torque)
          kinds.push_back(static_cast<int>(kind));
      out.dataset("", "pressure_kind", { n_torques, n_positions }, kinds, "0 regular, 1 kink, 2 edge",
                  { "pinion_torque", "phase" });
      table("edge_pressure", "MPa", [](const auto &p) { return p.edge_pressure; });
      table("gear_torque", "N m", [](const auto &p) { return p.gear_torque / units::newton_metre; });
      table("max_line_load", "N/mm", [](const auto &p) { return p.max_line_load; });
      table("tip_edge_load", "N/mm", [](const auto &p) { return p.tip_edge_load; });
      table("tip_intensity", "MPa mm^-tip_power", [](const auto &p) { return p.tip_intensity; });
      table("tip_power", "1", [](const auto &p) { return p.tip_power; });
      table("end_intensity", "MPa mm^-end_power", [](const auto &p) { return p.end_intensity; });
      table("end_power", "1", [](const auto &p) { return p.end_power; });
      table("load_centre_z", "mm", [](const auto &p) { return p.load_centre; });
      table("shuttling_moment", "N m",
            [](const auto &p) { return p.shuttling_moment / units::newton_metre; });
      if (input.has_tilt_springs())
        for (const auto &[axis, name] : { std::pair{ 0, "tilt_pinion_in_plane" },
                                          { 1, "tilt_pinion_across_plane" },
                                          { 2, "tilt_gear_in_plane" },
                                          { 3, "tilt_gear_across_plane" } })
          table(name, "mrad", [axis = axis](const auto &p) { return 1e3 * p.tilt[axis]; });
      table("certificate", "relative", [](const auto &p) { return p.certificate.worst(); });
      table("compliance_asymmetry", "relative", [](const auto &p) { return p.asymmetry; });
      table("compliance_condition", "1", [](const auto &p) { return p.condition; });
      table("contact_cells", "1", [](const auto &p) { return p.cells; });
    }

    /// The cells of a grid stand in consecutive rows, once for all torques that share it; their pressures
    /// once a torque and position.
    void add_cells(Hdf5File &out, const ParallelAxisResults &results)
    {
      const std::vector<std::size_t> shape = { results.at.size(), results.at.front().size() };
      std::map<const void *, int> row_of_grid;
      std::vector<GridCells> grids;
      int rows = 0;
      std::vector<int> first_cell, first_pressure, count;
      std::vector<double> pressure;
      for (const auto &positions : results.at)
        for (const PositionResult &p : positions)
          {
            if (const auto [it, is_new] = row_of_grid.try_emplace(p.grid_cells.get(), rows);
                is_new && p.grid_cells)
              {
                grids.push_back(p.grid_cells);
                rows += static_cast<int>(p.grid_cells->size());
              }
            first_cell.push_back(row_of_grid.at(p.grid_cells.get()));
            first_pressure.push_back(static_cast<int>(pressure.size()));
            count.push_back(static_cast<int>(p.cell_forces.size()));
            for (std::size_t i = 0; i < p.cell_forces.size(); ++i)
              pressure.push_back(p.cell_forces[i] / (*p.grid_cells)[i].area);
          }
      out.dataset("cells", "count", shape, count, "cells of this torque and position");
      out.dataset("cells", "first_cell", shape, first_cell, "its first row of pair, z, ... place");
      out.dataset("cells", "first_pressure", shape, first_pressure, "its first row of pressure");
      out.dataset("cells", "pressure", { pressure.size() }, pressure, "MPa");
      const auto column = [&](const std::string &name, const std::string &unit, const auto &value) {
        std::vector<decltype(value(GridCell{}))> values;
        for (const GridCells &grid : grids)
          for (const GridCell &cell : *grid)
            values.push_back(value(cell));
        out.dataset("cells", name, { values.size() }, values, unit);
      };
      column("pair", "1", [](const auto &c) { return c.pair; });
      column("z", "mm", [](const auto &c) { return c.z; });
      column("pinion_roll_angle", "deg", [](const auto &c) { return c.pinion_roll / units::degree; });
      column("gear_roll_angle", "deg", [](const auto &c) { return c.gear_roll / units::degree; });
      column("area", "mm^2", [](const auto &c) { return c.area; });
      column("unloaded_gap", "um", [](const auto &c) { return c.gap / units::micrometre; });
      column("place", "0 inside, 1 tip edge, 2 sharp face end, 3 corner, 4 finite face end, 5 rounded tip",
             [](const auto &c) { return static_cast<int>(c.place); });
    }

    /// What the summary, or a line at the head of a table, says of a torque and no table has.
    ResultTable of_torques(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      ResultTable table("of_torques", "",
                        { torque_column(),
                          { "K_Hbeta", "1", "{:.9g}" },
                          { "flank_used_percent", "%", "{:.9g}" },
                          { "noise_of_harmonics_um", "um", "{:.9g}" },
                          { "iso_6336_root_stress_pinion_MPa", "MPa", "{:.9g}" },
                          { "iso_6336_root_stress_gear_MPa", "MPa", "{:.9g}" } });
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          double face_load = std::numeric_limits<double>::quiet_NaN(), used = 0;
          if (input.torques[t] > 0)
            {
              const auto cycle = first_cycle(input, results.at[t]);
              face_load = face_load_factor(input.pair, cycle, input.grid.slices);
              used = covered_share(contact_pattern(input.pair, cycle, input.grid.slices));
            }
          const auto root = iso_6336_nominal_root_stress(input.pair, input.torques[t]);
          table.add({ input.torques[t] / units::newton_metre, face_load, 100 * used,
                      noise_of_harmonics(errors_over_cycle(input.pair, results.at[t])), root[0], root[1] });
        }
      return table;
    }

    void add_map(Hdf5File &out, const std::string &group, const FlankMap &values, const std::string &unit,
                 const double scale)
    {
      std::vector<double> roll, all;
      for (std::size_t i = 0; i < values.roll.size(); ++i)
        {
          roll.push_back(values.roll[i] / units::degree);
          for (std::size_t j = 0; j < values.z.size(); ++j)
            all.push_back(values.value(i, j) / scale);
        }
      out.dataset(group, "roll_angle", { values.roll.size() }, roll, "deg");
      out.dataset(group, "z", { values.z.size() }, values.z, "mm");
      out.dataset(group, "value", { values.roll.size(), values.z.size() }, all, unit, { "roll_angle", "z" });
    }

    /// The map over the pinion's roll angle, and the gear's roll angles where it meets it.
    void add_pattern(Hdf5File &out, const GearPair &pair, const ContactPattern &pattern)
    {
      const std::string group = fmt::format("{}/torque_{}", pattern.group, pattern.torque);
      add_map(out, group, pattern.pressure, "MPa", 1);
      std::vector<double> facing;
      for (const double roll : pattern.pressure.roll)
        facing.push_back(pair.facing_roll(pair.gear, pair.pinion, roll) / units::degree);
      out.dataset(group, "gear_roll_angle", { facing.size() }, facing, "deg");
    }
  } // namespace

  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input,
                  const ParallelAxisResults &results, const std::vector<ContactPattern> &patterns,
                  const std::vector<ResultTable> &tables, const std::string &versions)
  {
    Hdf5File out;
    write_head(out, { input.title, file.source(), file.resolved(), versions, conventions_of(input) });
    add_positions(out, input, results);
    add_cells(out, results);
    if (!input.deviations.pinion.modifications.empty() || !input.deviations.gear.modifications.empty())
      {
        const double um = units::micrometre;
        add_map(out, "modifications/pinion", pinion_modification(input.pair, input.deviations), "um", um);
        add_map(out, "modifications/gear", gear_modification(input.pair, input.deviations), "um", um);
        add_map(out, "modifications/sum", sum_of_modifications(input.pair, input.deviations), "um", um);
      }
    for (const ContactPattern &pattern : patterns)
      add_pattern(out, input.pair, pattern);
    for (const ResultTable &table : tables)
      table.write(out);
    of_torques(input, results).write(out);
    stage_table(results.stage_seconds).write(out);
    out.write_to(path);
  }
} // namespace flank
