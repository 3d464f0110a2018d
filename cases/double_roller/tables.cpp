// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/results.hpp"
#include "cases/double_roller/supports.hpp"
#include "cases/results/design_torques.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/results/hdf5_file.hpp"
#include "cases/results/hdf5_head.hpp"
#include "cases/results/result_table.hpp"
#include "contact/rollers/unloaded_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flank
{
  using units::arcsecond;
  using units::degree;

  namespace
  {
    const ResultTable::Column crank_angle = { "crank_angle_deg", "deg", "{:.9g}" },
                              roller = { "roller", "1", "{}" }, sleeve = { "sleeve", "1", "{}" },
                              flank = { "flank", "", "{}", { "drive", "coast" } };

    ResultTable te_table(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      ResultTable table("te", drive_conventions,
                        { torque_column(),
                          position_column(),
                          crank_angle,
                          { "te_um", "um", "{:.9f}" },
                          { "te_arcsec", "arcsec", "{:.9f}" },
                          { "carrier_rotation_deg", "deg", "{:.12g}" },
                          { "gear_ratio", "1", "{:.9f}" },
                          { "gear_ratio_instantaneous", "1", "{:.9f}" },
                          { "gear_ratio_secant", "1", "{:.9f}" },
                          { "contacts", "1", "{}" },
                          { "max_pressure_MPa", "MPa", "{:.4f}" },
                          { "edge_pressure_MPa", "MPa", "{:.4f}" },
                          { "mesh_stiffness_N_per_um", "N/um", "{:.6f}" },
                          { "torsional_stiffness_Nm_per_arcmin", "N m/arcmin", "{:.9f}" },
                          { "torsional_stiffness_secant_Nm_per_arcmin", "N m/arcmin", "{:.9f}" },
                          { "certificate", "relative", "{:.3e}" } });
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          {
            const DrivePosition &p = results.at[t][k];
            const Peaks q = peaks(p);
            table.add({ input.torques[t] / units::newton_metre, static_cast<double>(k),
                        p.crank_angle / degree, micrometres(input, p.lag), p.lag / arcsecond, p.psi / degree,
                        gear_ratio(input, results, t, k), p.gear_ratio, results.secant_gear_ratio[t][k],
                        static_cast<double>(p.pairs.size()), q.mid, q.edge, study_point(input, p).stiffness,
                        p.stiffness * per_arcmin, secant_stiffness(input, results, t, k) * per_arcmin,
                        std::max(p.balance, p.certificate) });
          }
      return table;
    }

    ResultTable pair_table(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      ResultTable table("pairs", drive_conventions,
                        { torque_column(),
                          position_column(),
                          crank_angle,
                          roller,
                          sleeve,
                          flank,
                          { "normal_force_N", "N", "{:.6f}" },
                          { "approach_um", "um", "{:.9f}" },
                          { "lever_mm", "mm", "{:.9f}" },
                          { "mid_pressure_MPa", "MPa", "{:.4f}" },
                          { "edge_pressure_MPa", "MPa", "{:.4f}" },
                          { "greatest_cell_pressure_MPa", "MPa", "{:.4f}" } });
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          for (const RollerPairLoad &load : results.at[t][k].pairs)
            table.add({ input.torques[t] / units::newton_metre, static_cast<double>(k),
                        results.at[t][k].crank_angle / degree, static_cast<double>(load.roller),
                        static_cast<double>(load.sleeve), load.lever > 0 ? 0.0 : 1.0, load.force,
                        load.approach / units::micrometre, load.lever, load.mid_pressure, load.edge_pressure,
                        load.max_pressure });
      return table;
    }

    ResultTable share_table(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      const auto part = [](const std::string &name) {
        return ResultTable::Column{ "te_by_" + name + "_arcsec", "arcsec", "{:.9f}", {}, "nan" };
      };
      std::vector<ResultTable::Column> columns = { torque_column(), position_column(),
                                                   crank_angle,     { "te_arcsec", "arcsec", "{:.9f}" },
                                                   part("gaps"),    part("contact") };
      for (const SupportPart support : support_parts)
        {
          std::string name = name_of(support);
          std::ranges::replace(name, ' ', '_');
          columns.push_back(part(name));
        }
      ResultTable table("shares", drive_conventions, columns);
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          {
            const DrivePosition &p = results.at[t][k];
            std::vector<double> row = { input.torques[t] / units::newton_metre,
                                        static_cast<double>(k),
                                        p.crank_angle / degree,
                                        p.lag / arcsecond,
                                        p.shares.gaps / arcsecond,
                                        p.shares.contact / arcsecond };
            for (const double by_support : p.shares.support)
              row.push_back(by_support / arcsecond);
            table.add(row);
          }
      return table;
    }

    ResultTable support_table(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      std::vector<std::string> parts;
      for (const SupportPart part : support_parts)
        parts.push_back(name_of(part));
      ResultTable table("supports", drive_conventions,
                        { torque_column(),
                          position_column(),
                          crank_angle,
                          { "part", "", "{}", parts },
                          sleeve,
                          { "force_x_N", "N", "{:.6f}" },
                          { "force_y_N", "N", "{:.6f}" },
                          { "displacement_x_um", "um", "{:.9f}" },
                          { "displacement_y_um", "um", "{:.9f}" } });
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          for (const SupportLoad &load : results.at[t][k].supports)
            table.add({ input.torques[t] / units::newton_metre, static_cast<double>(k),
                        results.at[t][k].crank_angle / degree, static_cast<double>(load.part),
                        static_cast<double>(load.sleeve), load.force_x, load.force_y,
                        load.displacement_x / units::micrometre, load.displacement_y / units::micrometre });
      return table;
    }

    ResultTable harmonic_table(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      ResultTable table("harmonics", drive_conventions, harmonic_columns());
      const VariantFrame frame = frame_of(input);
      const auto in_period = static_cast<std::size_t>(frame.period);
      for (std::size_t t = 0; in_period > 0 && t < input.torques.size(); ++t)
        {
          const auto list = mesh_harmonics(harmonics(lags_um(input, results.at[t], in_period)), frame.order);
          for (std::size_t i = 0; i < list.size(); ++i)
            table.add({ input.torques[t] / units::newton_metre, static_cast<double>(i + 1), list[i].amplitude,
                        list[i].phase / degree,
                        is_aliased(static_cast<int>(i + 1) * frame.order, frame.period) ? 1.0 : 0.0 });
        }
      return table;
    }

    /// The whole spectrum over the period of a drive whose parts have errors of their own.
    ResultTable sideband_table(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      ResultTable table("sidebands", drive_conventions,
                        { torque_column(),
                          { "line", "1", "{}" },
                          { "mesh_order", "1", "{:.9g}" },
                          { "crank_order", "1", "{:.9g}" },
                          { "carrier_order", "1", "{:.9g}" },
                          { "amplitude_um", "um", "{:.9f}" },
                          { "phase_deg", "deg", "{:.6f}" },
                          { "aliased", "0 no, 1 yes", "{}" } });
      const VariantFrame frame = frame_of(input);
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const auto all = harmonics(lags_um(input, results.at[t], static_cast<std::size_t>(frame.period)));
          for (std::size_t i = 0; i < all.size(); ++i)
            {
              const double order = (i + 1.0) / frame.order, of_crank = order * input.drive.rollers;
              table.add({ input.torques[t] / units::newton_metre, static_cast<double>(i + 1), order, of_crank,
                          of_crank * (input.drive.rollers - 1), all[i].amplitude, all[i].phase / degree,
                          is_aliased(static_cast<int>(i + 1), frame.period) ? 1.0 : 0.0 });
            }
        }
      return table;
    }

    ResultTable unloaded_table(const DoubleRollerCase &input, const LoadedDrive &drive)
    {
      ResultTable table("unloaded", drive_conventions,
                        { crank_angle,
                          roller,
                          sleeve,
                          flank,
                          { "contact_rotation_deg", "deg", "{:.12g}" },
                          { "backlash_arcsec", "arcsec", input.model.conjugate ? "{}" : "{:.9f}" },
                          { "gap_um", "um", "{:.9f}" },
                          { "lever_mm", "mm", "{:.9f}" },
                          { "phi_d_deg", "deg", "{:.12g}" } },
                        ResultTable::Variant::without);
      for (const double phi : input.crank_angles)
        for (const UnloadedContact &c : unloaded_contacts(drive, input.model.conjugate, phi))
          table.add({ phi / degree, static_cast<double>(c.roller), static_cast<double>(c.sleeve),
                      c.flank == DriveFlank::drive ? 0.0 : 1.0, c.rotation / degree, c.backlash / arcsecond,
                      c.gap / units::micrometre, c.lever, c.first / degree });
      return table;
    }

    /// The tables with one value at every torque and crank angle, and their two axes.
    void add_positions(Hdf5File &out, const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      const VariantFrame frame = frame_of(input);
      out.dataset("", "torque", { frame.loads.size() }, frame.loads, "N m");
      out.dataset("", "crank_angle", { frame.abscissa.size() }, frame.abscissa, "deg");
      out.dataset("", "period", { 1 }, std::vector<int>{ frame.period }, "positions");
      out.dataset("", "order", { 1 }, std::vector<int>{ frame.order }, "1");
      out.dataset("", "preload", { frame.abscissa.size() }, results.preload, "N", { "crank_angle" });
      const auto table = [&](const char *name, const char *unit, const auto &value) {
        std::vector<decltype(value(0, 0))> values;
        for (std::size_t t = 0; t < results.at.size(); ++t)
          for (std::size_t k = 0; k < results.at[t].size(); ++k)
            values.push_back(value(t, k));
        out.dataset("", name, { results.at.size(), frame.abscissa.size() }, values, unit,
                    { "torque", "crank_angle" });
      };
      const auto of_position = [&](const char *name, const char *unit, const auto &value) {
        table(name, unit, [&](const std::size_t t, const std::size_t k) { return value(results.at[t][k]); });
      };
      of_position("transmission_error", "um", [&](const auto &p) { return micrometres(input, p.lag); });
      of_position("transmission_error_slope", "um/(N m)",
                  [&](const auto &p) { return study_point(input, p).response_slope; });
      of_position("transmission_error_rotation", "arcsec", [&](const auto &p) { return p.lag / arcsecond; });
      of_position("carrier_rotation", "deg", [&](const auto &p) { return p.psi / degree; });
      table("gear_ratio", "1",
            [&](const std::size_t t, const std::size_t k) { return gear_ratio(input, results, t, k); });
      of_position("gear_ratio_instantaneous", "1", [](const auto &p) { return p.gear_ratio; });
      table("gear_ratio_secant", "1",
            [&](const std::size_t t, const std::size_t k) { return results.secant_gear_ratio[t][k]; });
      of_position("contacts", "1", [](const auto &p) { return static_cast<int>(p.pairs.size()); });
      of_position("max_pressure", "MPa", [](const auto &p) { return peaks(p).mid; });
      of_position("edge_pressure", "MPa", [](const auto &p) { return peaks(p).edge; });
      of_position("mesh_stiffness", "N/um", [&](const auto &p) { return study_point(input, p).stiffness; });
      of_position("torsional_stiffness", "N m/arcmin",
                  [](const auto &p) { return p.stiffness * per_arcmin; });
      table("torsional_stiffness_secant", "N m/arcmin", [&](const std::size_t t, const std::size_t k) {
        return secant_stiffness(input, results, t, k) * per_arcmin;
      });
      of_position("torque_balance", "relative", [](const auto &p) { return p.balance; });
      of_position("certificate", "relative",
                  [](const auto &p) { return std::max(p.balance, p.certificate); });
    }
  } // namespace

  void write_results(const ResultFolder &folder, const CaseFile &file, const DoubleRollerCase &input,
                     const LoadedDrive &drive, const DoubleRollerResults &results,
                     const std::string &versions)
  {
    std::vector<ResultTable> tables = { te_table(input, results), harmonic_table(input, results),
                                        pair_table(input, results), unloaded_table(input, drive) };
    if (input.supports.any())
      {
        tables.push_back(share_table(input, results));
        tables.push_back(support_table(input, results));
      }
    const VariantFrame frame = frame_of(input);
    if (frame.period > 0 && frame.order > 1)
      tables.push_back(sideband_table(input, results));
    const std::vector<StudyPoint> points = study_points(input, results);
    if (has_design_torques(frame))
      tables.push_back(design_torques(frame, points, std::nullopt, drive_conventions));
    if (ResultTable over_torque = amplitudes_over_torque(frame, points, std::nullopt, drive_conventions);
        !over_torque.empty())
      tables.push_back(std::move(over_torque));
    for (const ResultTable &table : tables)
      table.write(folder);
    tables.erase(
        tables.begin()); // results.h5 has transmission error and its companions over torque and angle
    folder.write("results.h5", [&](const std::string &path) {
      Hdf5File out;
      write_head(out, { input.title, file.source(), file.resolved(), versions, drive_conventions });
      add_positions(out, input, results);
      input.pressure_maps.write(out, drive, results);
      for (const ResultTable &table : tables)
        table.write(out);
      stage_table(results.stage_seconds).write(out);
      out.write_to(path);
    });
    folder.write("case.toml", file.source_with_settings());
    folder.write("summary.txt", summary(input, results));
  }
} // namespace flank
