// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/results.hpp"
#include "mesh/base/units.hpp"

#include <deal.II/base/hdf5.h>

namespace flank
{
  void write_hdf5(const std::string &path, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results,
                  const std::string &versions)
  {
    namespace h5 = dealii::HDF5;
    h5::File out(path, h5::File::FileAccessMode::create);
    out.set_attribute("title", input.title);
    out.set_attribute("case_as_given", file.source());
    out.set_attribute("case_as_resolved", file.resolved());
    out.set_attribute("versions", versions);
    out.set_attribute("conventions",
                      std::string("TE along the transverse line of action, positive when the driven gear lags; harmonics A_i = 2|c_i|; z "
                                  "along the axis, 0 at mid-face; "
                                  "roll angles sqrt((r/r_b)^2 - 1); pressures compressive positive; body ring clamped at the bore"));
    const auto n_torques = static_cast<hsize_t>(input.torques.size()), n_positions = static_cast<hsize_t>(input.positions);
    const auto write = [](h5::Group &group, const std::string &name, const std::vector<hsize_t> &shape, const std::vector<double> &values,
                          const std::string &unit) {
      auto dataset = group.create_dataset<double>(name, shape);
      dataset.write(values);
      dataset.set_attribute("unit", unit);
    };
    std::vector<double> torques, phases;
    for (const double torque : input.torques)
      torques.push_back(torque / units::newton_metre);
    for (int k = 0; k < input.positions; ++k)
      phases.push_back(static_cast<double>(k) / input.positions);
    write(out, "pinion_torque", { n_torques }, torques, "N m");
    write(out, "phase", { n_positions }, phases, "mesh cycle");
    const auto table = [&](const std::string &name, const std::string &unit, const auto &value) {
      std::vector<double> values;
      for (const auto &positions : results.at)
        for (const PositionResult &p : positions)
          values.push_back(value(p));
      write(out, name, { n_torques, n_positions }, values, unit);
    };
    table("transmission_error", "um", [&](const auto &p) { return transmission_error_um(input.pair, p); });
    table("mesh_stiffness", "N/um", [&](const auto &p) { return mesh_stiffness(input.pair, p); });
    table("max_pressure", "MPa", [](const auto &p) { return p.max_pressure; });
    table("max_pressure_roll_angle", "deg", [](const auto &p) { return p.max_pressure_roll / units::degree; });
    table("max_pressure_z", "mm", [](const auto &p) { return p.max_pressure_z; });
    table("edge_pressure", "MPa", [](const auto &p) { return p.edge_pressure; });
    table("gear_torque", "N m", [](const auto &p) { return p.gear_torque / units::newton_metre; });
    table("certificate", "relative", [](const auto &p) { return p.certificate.worst(); });
    table("compliance_asymmetry", "relative", [](const auto &p) { return p.asymmetry; });
    table("contact_cells", "1", [](const auto &p) { return static_cast<double>(p.cells); });

    h5::Group cells = out.create_group("cells");
    for (std::size_t t = 0; t < results.at.size(); ++t)
      for (std::size_t k = 0; k < results.at[t].size(); ++k)
        if (const auto &list = results.at[t][k].cell_results; !list.empty())
          {
            h5::Group  group  = cells.create_group("torque_" + std::to_string(t) + "_position_" + std::to_string(k));
            const auto column = [&](const std::string &name, const std::string &unit, const auto &value) {
              std::vector<double> values;
              for (const CellResult &cell : list)
                values.push_back(value(cell));
              write(group, name, { static_cast<hsize_t>(list.size()) }, values, unit);
            };
            column("pair", "1", [](const auto &c) { return static_cast<double>(c.pair); });
            column("z", "mm", [](const auto &c) { return c.z; });
            column("pinion_roll_angle", "deg", [](const auto &c) { return c.pinion_roll / units::degree; });
            column("gear_roll_angle", "deg", [](const auto &c) { return c.gear_roll / units::degree; });
            column("area", "mm^2", [](const auto &c) { return c.area; });
            column("unloaded_gap", "um", [](const auto &c) { return c.gap / units::micrometre; });
            column("pressure", "MPa", [](const auto &c) { return c.force / c.area; });
            column("edge", "1", [](const auto &c) { return c.edge ? 1.0 : 0.0; });
          }
  }
} // namespace flank
