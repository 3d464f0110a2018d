// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/hdf5_file.hpp"
#include "cases/parallel_axis/report/load_distribution.hpp"
#include "cases/parallel_axis/report/results.hpp"
#include "mesh/base/units.hpp"

namespace flank
{
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results,
                  const std::string &versions)
  {
    Hdf5File out(path);
    out.attribute("title", input.title);
    out.attribute("case_as_given", file.source());
    out.attribute("case_as_resolved", file.resolved());
    out.attribute("versions", versions);
    out.attribute(
        "conventions",
        "TE along the transverse line of action, positive when the driven gear lags; harmonics A_i = 2|c_i|; z along the axis, 0 at "
        "mid-face; roll angles sqrt((r/r_b)^2 - 1); pressures compressive positive; body " +
            input.body.describe());
    const auto          n_torques = input.torques.size(), n_positions = static_cast<std::size_t>(input.positions) * input.cycles;
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
    table("max_pressure_roll_angle", "deg", [](const auto &p) { return p.max_pressure_roll / units::degree; });
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
        table(name, "mrad", [&](const auto &p) { return 1e3 * p.tilt[axis]; });
    table("certificate", "relative", [](const auto &p) { return p.certificate.worst(); });
    table("compliance_asymmetry", "relative", [](const auto &p) { return p.asymmetry; });
    table("contact_cells", "1", [](const auto &p) { return static_cast<double>(p.cells); });

    // Cells of all torques and positions one after the other; those of one start at `first` and are as many as the next start says.
    std::vector<double> first{ 0 };
    for (const auto &positions : results.at)
      for (const PositionResult &p : positions)
        first.push_back(first.back() + static_cast<double>(p.cell_results.size()));
    const auto n_cells = static_cast<std::size_t>(first.back());
    first.pop_back();
    out.dataset("cells", "first", { n_torques, n_positions }, first, "row of the other datasets of this group");
    const auto column = [&](const std::string &name, const std::string &unit, const auto &value) {
      std::vector<double> values;
      values.reserve(n_cells);
      for (const auto &positions : results.at)
        for (const PositionResult &p : positions)
          for (const CellResult &cell : p.cell_results)
            values.push_back(value(cell));
      out.dataset("cells", name, { n_cells }, values, unit);
    };
    column("pair", "1", [](const auto &c) { return static_cast<double>(c.pair); });
    column("z", "mm", [](const auto &c) { return c.z; });
    column("pinion_roll_angle", "deg", [](const auto &c) { return c.pinion_roll / units::degree; });
    column("gear_roll_angle", "deg", [](const auto &c) { return c.gear_roll / units::degree; });
    column("area", "mm^2", [](const auto &c) { return c.area; });
    column("unloaded_gap", "um", [](const auto &c) { return c.gap / units::micrometre; });
    column("pressure", "MPa", [](const auto &c) { return c.force / c.area; });
    column("place", "0 inside, 1 tip edge, 2 face end, 3 corner", [](const auto &c) { return static_cast<double>(c.place); });
    const auto map = [&](const std::string &group, const FlankMap &values, const std::string &unit, const double scale) {
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
        map("modifications/pinion", pinion_modification(input.pair, input.deviations), "um", units::micrometre);
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
  }
} // namespace flank
