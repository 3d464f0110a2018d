// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/results.hpp"

#include "cases/parallel_axis/extras/pressure_kind.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/results/design_torques.hpp"
#include "cases/results/harmonics.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

namespace flank
{
  namespace
  {
    /// Bounds of what is wrong at a torque, as far as they are estimated.
    const ErrorsOfTorque &errors_of(const ParallelAxisResults &results, const std::size_t torque)
    {
      static const ErrorsOfTorque unknown;
      return results.errors.empty() ? unknown : results.errors[torque];
    }

    /// Calls use(number of the torque, torque [N m], number of the position, result) for every solution, in
    /// the order of tables.
    template <class Use>
    void each_solution(const ParallelAxisCase &input, const ParallelAxisResults &results, const Use &use)
    {
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          use(t, input.torques[t] / units::newton_metre, static_cast<double>(k), results.at[t][k]);
    }

    ResultTable te_table(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      const GearPair &pair = input.pair;
      ResultTable table(
          "te",
          std::string(conventions) +
              "# te_bound_um, max_pressure_bound_MPa: upper bounds of the errors of te_um and, "
              "away from kinks and edges, of max_pressure_MPa; nan: not estimated\n"
              "# pressure_kind: whether max_pressure_MPa has a limit as cells shrink; kink: it "
              "is at or near a kink of a flank, or half as much is; edge: edges and face ends carry more\n"
              "# tip_edge_load_N_per_mm: greatest force per length of a tip edge beyond the "
              "path of action, 5 % of the face away from its ends; tip_intensity, tip_power: at the sharp "
              "tip edge of the greatest intensity pressure comes to the intensity times the distance to the "
              "power (0: none carries)\n"
              "# edge_pressure_MPa: at sharp edges, where it grows as cells shrink; at face "
              "ends it comes to end_intensity times the distance to the power end_power (0: "
              "no sharp face end carries)\n",
          { torque_column(),
            position_column(),
            phase_column(),
            { "te_um", "um", "{:.9f}" },
            { "te_arcsec", "arcsec", "{:.9f}" },
            { "contacts", "1", "{}" },
            { "max_pressure_MPa", "MPa", "{:.4f}" },
            { "max_pressure_pinion_roll_angle_deg", "deg", "{:.6f}" },
            { "max_pressure_z_mm", "mm", "{:.6f}" },
            { "edge_pressure_MPa", "MPa", "{:.4f}" },
            { "mesh_stiffness_N_per_um", "N/um", "{:.6f}" },
            { "secant_stiffness_N_per_um", "N/um", "{:.6f}" },
            { "gear_torque_Nm", "N m", "{:.9g}" },
            { "max_line_load_N_per_mm", "N/mm", "{:.6f}" },
            { "tip_edge_load_N_per_mm", "N/mm", "{:.6f}" },
            { "tip_intensity_MPa_mm", "MPa mm^-tip_power", "{:.4f}" },
            { "tip_power", "1", "{:.6f}" },
            { "end_intensity_MPa_mm", "MPa mm^-end_power", "{:.4f}" },
            { "end_power", "1", "{:.6f}" },
            { "load_centre_z_mm", "mm", "{:.6f}" },
            { "shuttling_moment_Nm", "N m", "{:.9f}" },
            { "certificate", "relative", "{:.3e}" },
            bound_column("te_bound_um", "um"),
            bound_column("max_pressure_bound_MPa", "MPa", "{:.4f}"),
            { "pressure_kind", "", "{}", pressure_kinds() } });
      const std::vector<std::vector<PressureKind>> kinds = pressure_kinds_of(input, results.at);
      each_solution(input, results,
                    [&](const std::size_t t, const double torque, const double k, const PositionResult &p) {
                      const ErrorsOfTorque &errors = errors_of(results, t);
                      table.add({ torque,
                                  k,
                                  p.phase,
                                  transmission_error_um(pair, p),
                                  transmission_error_arcsec(pair, p),
                                  static_cast<double>(p.pairs.size()),
                                  p.max_pressure,
                                  p.max_pressure_roll / units::degree,
                                  p.max_pressure_z,
                                  p.edge_pressure,
                                  tangent_stiffness(pair, p) / units::newton_per_micrometre,
                                  secant_stiffness(pair, p) / units::newton_per_micrometre,
                                  p.gear_torque / units::newton_metre,
                                  p.max_line_load,
                                  p.tip_edge_load,
                                  p.tip_intensity,
                                  p.tip_power,
                                  p.end_intensity,
                                  p.end_power,
                                  p.load_centre,
                                  p.shuttling_moment / units::newton_metre,
                                  p.certificate.worst(),
                                  errors.te.position,
                                  errors.bound_of_pressure(static_cast<std::size_t>(k)),
                                  static_cast<double>(kinds[t][static_cast<std::size_t>(k)]) });
                    });
      return table;
    }

    ResultTable pair_table(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      ResultTable table("pairs",
                        std::string(conventions) +
                            "# load_share_bound: upper bound of the error of load_share; "
                            "nan: not estimated\n",
                        { torque_column(),
                          position_column(),
                          phase_column(),
                          { "pair", "1", "{}" },
                          { "normal_force_N", "N", "{:.6f}" },
                          { "load_share", "1", "{:.9f}" },
                          { "max_pressure_MPa", "MPa", "{:.4f}" },
                          bound_column("load_share_bound", "1") });
      each_solution(input, results,
                    [&](const std::size_t t, const double torque, const double k, const PositionResult &p) {
                      const double bound = errors_of(results, t).load_share;
                      for (const PairLoad &load : p.pairs)
                        table.add({ torque, k, p.phase, static_cast<double>(load.pair), load.force,
                                    load_share(p, load), load.max_pressure, bound });
                    });
      return table;
    }

    ResultTable line_table(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      ResultTable table("lines", conventions,
                        { torque_column(),
                          position_column(),
                          phase_column(),
                          { "pair", "1", "{}" },
                          { "z_mm", "mm", "{:.6f}" },
                          { "pinion_roll_angle_deg", "deg", "{:.6f}" },
                          { "load_per_length_N_per_mm", "N/mm", "{:.6f}" },
                          { "max_pressure_MPa", "MPa", "{:.4f}" },
                          { "extent_mm", "mm", "{:.12g}" },
                          { "tip_edge_load_N_per_mm", "N/mm", "{:.6f}" },
                          { "tip_intensity_MPa_mm", "MPa mm^-tip_power", "{:.4f}" },
                          { "tip_power", "1", "{:.6f}" } });
      each_solution(input, results,
                    [&](std::size_t, const double torque, const double k, const PositionResult &p) {
                      for (const LineLoad &line : p.lines)
                        table.add({ torque, k, p.phase, static_cast<double>(line.pair), line.z,
                                    line.pinion_roll / units::degree, line.load_per_length, line.max_pressure,
                                    line.height, line.tip_edge_load, line.tip_intensity, line.tip_power });
                    });
      return table;
    }

    /// Of the amplitude of a mesh harmonic, by its number. [um]
    double bound_of_harmonic(const ParallelAxisResults &results, const std::size_t t,
                             const std::size_t harmonic)
    {
      const TransmissionErrorBounds &bounds = errors_of(results, t).te;
      return harmonic <= bounds.amplitude.size() ? bounds.amplitude[harmonic - 1] : ErrorsOfTorque::unknown;
    }

    /// With bounds of the first mesh harmonics where they are estimated.
    ResultTable harmonic_table(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      std::string heading = conventions;
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        heading +=
            fmt::format("# at {:.6g} N m amplitudes below {:.6f} um may be noise of the contact grid\n",
                        input.torques[t] / units::newton_metre,
                        noise_of_harmonics(errors_over_cycle(input.pair, results.at[t])));
      heading += "# bound_um: upper bound of the amplitude's error; nan: not estimated\n";
      std::vector<ResultTable::Column> columns = harmonic_columns();
      columns.push_back(bound_column("bound_um", "um"));
      ResultTable table("harmonics", heading, columns);
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const auto list =
              mesh_harmonics(harmonics(errors_over_cycle(input.pair, results.at[t])), input.cycles);
          for (std::size_t i = 0; i < list.size(); ++i)
            table.add({ input.torques[t] / units::newton_metre, static_cast<double>(i + 1), list[i].amplitude,
                        list[i].phase / units::degree,
                        is_aliased(static_cast<int>(i + 1), input.positions) ? 1.0 : 0.0,
                        bound_of_harmonic(results, t, i + 1) });
        }
      return table;
    }

    /// Lines of the spectrum over all mesh cycles until the same teeth meet again.
    ResultTable sideband_table(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      const GearPair &pair = input.pair;
      ResultTable table("sidebands",
                        std::string(conventions) + "# bound_um: upper bound of the error of a mesh "
                                                   "harmonic's amplitude; nan: not estimated\n",
                        { torque_column(),
                          { "line", "1", "{}" },
                          { "mesh_order", "1", "{:.9g}" },
                          { "pinion_order", "1", "{:.9g}" },
                          { "gear_order", "1", "{:.9g}" },
                          { "amplitude_um", "um", "{:.9f}" },
                          { "phase_deg", "deg", "{:.6f}" },
                          { "aliased", "0 no, 1 yes", "{}" },
                          bound_column("bound_um", "um") });
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const auto all = harmonics(errors_over_cycle(pair, results.at[t]));
          const auto cycles = static_cast<std::size_t>(input.cycles);
          for (std::size_t i = 0; i < all.size(); ++i)
            {
              const double order = (i + 1.0) / input.cycles;
              table.add({ input.torques[t] / units::newton_metre, static_cast<double>(i + 1), order,
                          order * pair.pinion.teeth, order * pair.gear.teeth, all[i].amplitude,
                          all[i].phase / units::degree,
                          is_aliased(static_cast<int>(i + 1), input.positions * input.cycles) ? 1.0 : 0.0,
                          (i + 1) % cycles == 0 ? bound_of_harmonic(results, t, (i + 1) / cycles)
                                                : ErrorsOfTorque::unknown });
            }
        }
      return table;
    }

    /// Contact patterns of the torques, each with those of extras behind it.
    std::vector<ContactPattern> patterns_of(const ParallelAxisCase &input, const ParallelAxisResults &results,
                                            const std::vector<ExtraOutput> &extras)
    {
      std::vector<ContactPattern> patterns;
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        if (input.torques[t] > 0)
          {
            const int number = static_cast<int>(t);
            patterns.push_back(
                { number, 1, "contact_pattern",
                  contact_pattern(input.pair, first_cycle(input, results.at[t]), input.grid.slices) });
            for (const ExtraOutput &extra : extras)
              std::copy_if(extra.patterns.begin(), extra.patterns.end(), std::back_inserter(patterns),
                           [&](const ContactPattern &pattern) { return pattern.torque == number; });
          }
      return patterns;
    }

    /// Rows of roll angle, z and value over `unit`; `facing`, where it is given, adds the mate's roll angle
    /// [rad] to each.
    std::string map_rows(const std::string &prefix, const FlankMap &map, const double unit,
                         const std::function<double(double roll)> &facing = {})
    {
      std::string rows;
      for (std::size_t i = 0; i < map.roll.size(); ++i)
        {
          const std::string last =
              facing ? fmt::format(",{:.6f}", facing(map.roll[i]) / units::degree) : std::string();
          for (std::size_t j = 0; j < map.z.size(); ++j)
            rows += fmt::format("{}{:.6f},{:.6f},{:.6f}{}\n", prefix, map.roll[i] / units::degree, map.z[j],
                                map.value(i, j) / unit, last);
        }
      return rows;
    }

    std::string pattern_csv(const ParallelAxisCase &input, const std::vector<ContactPattern> &patterns)
    {
      std::string rows = conventions + std::string("# greatest pressure over one mesh cycle, on the pinion's "
                                                   "loaded flank\n"
                                                   "variant,torque_Nm,pinion_roll_angle_deg,z_mm,"
                                                   "pressure_MPa,gear_roll_angle_deg\n");
      std::set<std::string> torques; // a share of one may be another one, whose pattern is the same
      for (const ContactPattern &pattern : patterns)
        if (const auto [torque, is_new] = torques.insert(fmt::format(
                "0,{:.9g},", pattern.share * (input.torques[pattern.torque] / units::newton_metre)));
            is_new)
          rows += map_rows(*torque, pattern.pressure, 1, [&](const double roll) {
            return input.pair.facing_roll(input.pair.gear, input.pair.pinion, roll);
          });
      return rows;
    }

    std::string modification_csv(const ParallelAxisCase &input)
    {
      return "# material removed normal to the flank; sum: where both meet, over the pinion's roll angle\n"
             "flank,roll_angle_deg,z_mm,removed_um\n" +
             map_rows("pinion,", pinion_modification(input.pair, input.deviations), units::micrometre) +
             map_rows("gear,", gear_modification(input.pair, input.deviations), units::micrometre) +
             map_rows("sum,", sum_of_modifications(input.pair, input.deviations), units::micrometre);
    }
  } // namespace

  void write_results(const ResultFolder &folder, const CaseFile &file, const ParallelAxisCase &input,
                     const ParallelAxisResults &results, const std::vector<ExtraOutput> &extras,
                     const std::string &versions)
  {
    std::vector<ResultTable> tables = { te_table(input, results), harmonic_table(input, results),
                                        pair_table(input, results), line_table(input, results) };
    if (input.cycles > 1)
      tables.push_back(sideband_table(input, results));
    const VariantFrame frame = frame_of(input);
    const std::vector<StudyPoint> points = study_points(input, results);
    const std::vector<DesignBounds> bounds = design_bounds(results.errors);
    if (has_design_torques(frame))
      tables.push_back(design_torques(frame, points, bounds, conventions));
    if (ResultTable over_torque = amplitudes_over_torque(frame, points, bounds, conventions);
        !over_torque.empty())
      tables.push_back(std::move(over_torque));
    for (const ExtraOutput &extra : extras)
      if (extra.table)
        tables.push_back(*extra.table);
    for (const ResultTable &table : tables)
      table.write(folder);
    const std::vector<ContactPattern> patterns = patterns_of(input, results, extras);
    folder.write("pattern.csv", pattern_csv(input, patterns));
    if (!input.deviations.pinion.modifications.empty() || !input.deviations.gear.modifications.empty())
      folder.write("modifications.csv", modification_csv(input));
    tables.erase(
        tables.begin()); // results.h5 has transmission error and its companions over torque and phase
    folder.write("results.h5", [&](const std::string &path) {
      write_hdf5(path, file, input, results, patterns, tables, versions);
    });
    folder.write("case.toml", file.source_with_settings());
    folder.write("summary.txt", summary(input, results, extras));
  }
} // namespace flank
