// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/results.hpp"

#include "cases/results/harmonics.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace flank
{
  namespace
  {
    std::vector<double> errors_over_cycle(const GearPair &pair, const std::vector<PositionResult> &positions)
    {
      std::vector<double> values;
      for (const PositionResult &position : positions)
        values.push_back(transmission_error_um(pair, position));
      return values;
    }

    double mean_error_um(const GearPair &pair, const std::vector<PositionResult> &positions)
    {
      const std::vector<double> values = errors_over_cycle(pair, positions);
      return std::accumulate(values.begin(), values.end(), 0.0) / values.size();
    }

    /// Least and greatest share of the normal force that one loaded tooth pair carries over the cycle.
    std::pair<double, double> load_shares(const std::vector<PositionResult> &positions)
    {
      double least = 1, greatest = 0;
      for (const PositionResult &position : positions)
        {
          double total = 0;
          for (const PairLoad &load : position.pairs)
            total += load.force;
          for (const PairLoad &load : position.pairs)
            {
              least    = std::min(least, load.force / total);
              greatest = std::max(greatest, load.force / total);
            }
        }
      return { least, greatest };
    }

    /// ISO 6336-3's beside ours: a line with its factors.
    std::string nominal_root_stress(const GearPair &pair, const double torque)
    {
      const auto stress = iso_6336_nominal_root_stress(pair, torque);
      const auto pinion = iso_6336_root_stress(pair, pair.pinion),
                 gear   = iso_6336_root_stress(pair, pair.gear);
      return fmt::format(" ISO 6336-3 method B nominal, all load factors 1: pinion {:.1f} MPa (Y_F {:.3f}, "
                         "Y_S {:.3f}, Y_beta {:.3f}), gear "
                         "{:.1f} MPa (Y_F {:.3f}, Y_S {:.3f})\n",
                         stress[0], pinion.form_factor, pinion.stress_correction, pinion.helix_factor,
                         stress[1], gear.form_factor, gear.stress_correction);
    }

    std::vector<PositionResult> first_cycle(const ParallelAxisCase            &input,
                                            const std::vector<PositionResult> &positions)
    {
      return { positions.begin(),
               positions.begin() + std::min<std::ptrdiff_t>(input.positions, positions.size()) };
    }

    /// Mesh harmonics: every `cycles`-th line of the spectrum over the whole period.
    std::vector<Harmonic> mesh_harmonics(const std::vector<Harmonic> &spectrum, const int cycles)
    {
      std::vector<Harmonic> result;
      for (std::size_t i = cycles; i <= spectrum.size(); i += cycles)
        result.push_back(spectrum[i - 1]);
      return result;
    }

    bool any(const FlankModifications &modifications)
    {
      return !modifications.empty();
    }

    std::string map_rows(const std::string &prefix, const FlankMap &map, const double unit)
    {
      std::string rows;
      for (std::size_t i = 0; i < map.roll.size(); ++i)
        for (std::size_t j = 0; j < map.z.size(); ++j)
          rows += fmt::format("{}{:.6f},{:.6f},{:.6f}\n", prefix, map.roll[i] / units::degree, map.z[j],
                              map.value(i, j) / unit);
      return rows;
    }

    const char *conventions = "# TE eps = r_b_pinion theta_pinion + r_b_gear theta_gear along the transverse "
                              "line of action, both counted "
                              "in the pinion's sense;\n"
                              "# positive when the driven gear lags. te_arcsec: of the driven gear. phase 0: "
                              "pair 0 at the pitch point at "
                              "mid-face; 1: one pitch on.\n"
                              "# A_i = 2|c_i|: peak amplitude of mesh harmonic i, eps = mean + sum A_i cos(2 "
                              "pi i phase + phase_deg).\n";
  } // namespace

  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results)
  {
    const GearPair &pair = input.pair;
    std::string     r    = fmt::format(
               "{}\nbody: {} (bore: pinion {:.3f} mm, gear {:.3f} mm); {} split; {} positions{}; {} and {} unknowns "
                      "a sector\n\n",
               input.title, input.body.describe(), 2 * pair.pinion.bore_radius, 2 * pair.gear.bore_radius,
        input.near_field.split == Split::projected ? "projected" : "classical", input.positions,
        input.cycles > 1 ? fmt::format(" in each of {} mesh cycles", input.cycles) : "",
               results.unknowns_pinion, results.unknowns_gear);
    r += fmt::format("{:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n",
                     "torque", "mean TE", "peak-peak", "A1", "A2", "A3", "A4", "A5", "contact", "pressure",
                     "edge", "tangent k", "secant k");
    r += fmt::format("{:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n",
                     "N m", "um", "um", "um", "um", "um", "um", "um", "ratio", "MPa", "MPa", "N/um", "N/um");
    std::vector<std::string> warnings = pair.warnings;
    double                   worst = 0, asymmetry = 0;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const auto  &positions = results.at[t];
        const auto   te        = errors_over_cycle(pair, positions);
        const auto   spectrum  = mesh_harmonics(harmonics(te), input.cycles);
        const double mean      = mean_error_um(pair, positions);
        double       contact = 0, pressure = 0, edge = 0, tangent = 0;
        for (const PositionResult &p : positions)
          {
            contact += static_cast<double>(p.pairs.size()) / positions.size();
            pressure = std::max(pressure, p.max_pressure);
            edge     = std::max(edge, p.edge_pressure);
            tangent += mesh_stiffness(pair, p) / positions.size();
            worst     = std::max(worst, p.certificate.worst());
            asymmetry = std::max(asymmetry, p.asymmetry);
          }
        const auto amplitude = [&](const std::size_t i) {
          return i < spectrum.size() ? spectrum[i].amplitude : 0;
        };
        const double secant = input.torques[t] > 0 ? input.torques[t] / pair.pinion.base_radius / mean : 0;
        r += fmt::format("{:>10.3f} {:>10.4f} {:>10.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f} "
                         "{:>8.3f} {:>9.1f} {:>9.1f} {:>9.2f} {:>9.2f}\n",
                         input.torques[t] / units::newton_metre, mean,
                         *std::max_element(te.begin(), te.end()) - *std::min_element(te.begin(), te.end()),
                         amplitude(0), amplitude(1), amplitude(2), amplitude(3), amplitude(4), contact,
                         pressure, edge, tangent, secant);
      }
    r += fmt::format("\n{:>10} {:>26} {:>40} {:>9} {:>9} {:>9} {:>19}\n{:>10} {:>12} {:>12} {:>14} {:>12} "
                     "{:>12} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
                     "torque", "load share of one pair", "where the greatest pressure is", "line load",
                     "K_Hbeta", "flank", "shuttling moment", "N m", "least", "greatest", "pinion roll deg",
                     "z mm", "phase", "N/mm", "", "used %", "mean N m", "p-p N m");
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      if (input.torques[t] > 0)
        {
          const auto [least, greatest] = load_shares(results.at[t]);
          const auto &peak =
              *std::max_element(results.at[t].begin(), results.at[t].end(),
                                [](const auto &a, const auto &b) { return a.max_pressure < b.max_pressure; });
          double line_load = 0, mean_moment = 0, low_moment = 1e300, high_moment = -1e300;
          for (const PositionResult &p : results.at[t])
            {
              line_load = std::max(line_load, p.max_line_load);
              mean_moment += p.shuttling_moment / results.at[t].size();
              low_moment  = std::min(low_moment, p.shuttling_moment);
              high_moment = std::max(high_moment, p.shuttling_moment);
            }
          const auto cycle = first_cycle(input, results.at[t]);
          r += fmt::format(
              "{:>10.3f} {:>12.4f} {:>12.4f} {:>14.4f} {:>12.4f} {:>12.4f} {:>9.1f} {:>9.4f} {:>9.1f} "
              "{:>9.4f} {:>9.4f}\n",
              input.torques[t] / units::newton_metre, least, greatest, peak.max_pressure_roll / units::degree,
              peak.max_pressure_z, peak.phase, line_load, face_load_factor(pair, cycle, input.grid.slices),
              100 * covered_share(contact_pattern(pair, cycle, input.grid.slices)),
              mean_moment / units::newton_metre, (high_moment - low_moment) / units::newton_metre);
          const double deflection =
              mean_error_um(pair, results.at[t]) * units::micrometre / pair.data.transverse_module;
          if (deflection > 0.05)
            warnings.push_back(fmt::format(
                "at {:.6g} N m the mean transmission error is {:.2g} of the module: small-displacement "
                "elasticity is no longer a good model",
                input.torques[t] / units::newton_metre, deflection));
        }
    for (std::size_t t = 0; input.root_stress && t < input.torques.size(); ++t)
      {
        const RootStress *most[2] = { nullptr, nullptr };
        for (const RootStress &root : results.root_stress)
          if (root.torque == static_cast<int>(t) &&
              (!most[root.body] || root.stress > most[root.body]->stress))
            most[root.body] = &root;
        if (most[0] && most[1])
          r += fmt::format("greatest tensile root stress at {:.6g} N m: pinion {:.1f} MPa at z = {:.3f} mm, "
                           "gear {:.1f} MPa at z = {:.3f} mm\n",
                           input.torques[t] / units::newton_metre, most[0]->stress, most[0]->z,
                           most[1]->stress, most[1]->z) +
               nominal_root_stress(pair, input.torques[t]);
      }
    r += "\nPressures in cells at tip edges, cut cells and face ends stand apart (edge): no half-space is "
         "there, and they grow as cells "
         "shrink.\n";
    if (input.at_other_level)
      {
        r += fmt::format("error estimate: by how much results of the {} level differ\n{:>10} {:>12} {:>12} "
                         "{:>12} {:>12} {:>12}\n",
                         input.at_other_level->level, "torque", "mean TE", "TE rms", "p-p TE", "A1",
                         "pressure");
        r += fmt::format("{:>10} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "N m", "um", "um", "um", "um", "%");
        for (std::size_t t = 0; t < results.error_estimate.size(); ++t)
          {
            const ErrorEstimate &e = results.error_estimate[t];
            r += fmt::format("{:>10.3f} {:>12.4f} {:>12.4f} {:>12.4f} {:>12.4f} {:>12.2f}\n",
                             input.torques[t] / units::newton_metre, e.mean, e.oscillation, e.peak_to_peak,
                             e.first_harmonic, 100 * e.pressure);
          }
      }
    const IsoStiffness iso = iso_6336_stiffness(pair);
    r += fmt::format("ISO 6336-1 method B for comparison: c' {:.2f}, c_gamma_alpha {:.2f}, c_gamma_beta "
                     "{:.2f} N/(mm um); c_gamma_alpha is "
                     "{:.1f} N/um over the common face width\n",
                     iso.single, iso.mesh, 0.85 * iso.mesh, iso.mesh * pair.common_face_width);
    r += fmt::format("certificate: holds for all {} solutions, worst relative violation {:.2e}; compliance "
                     "asymmetry before symmetrising up to {:.2e}\n",
                     input.torques.size() * input.positions * input.cycles, worst, asymmetry);
    for (const std::string &warning : warnings)
      r += "warning: " + warning + "\n";
    r += conventions;
    for (const auto &[name, time] : results.stage_seconds)
      r += fmt::format("{:<68}{:>8.2f} s\n", name, time);
    return r;
  }

  void write_results(const ResultFolder &folder, const CaseFile &file, const ParallelAxisCase &input,
                     const ParallelAxisResults &results, const std::string &versions)
  {
    const GearPair &pair = input.pair;

    std::string te = conventions, spectrum = conventions, pairs = conventions, lines = conventions,
                sidebands = conventions, pattern = conventions, subsurface = conventions;
    subsurface += "# below the greatest pressure inside the flanks, half-space under the actual pressures; "
                  "depths from the surface\n"
                  "variant,torque_Nm,position,phase,max_pressure_MPa,shear_MPa,shear_depth_um,von_mises_MPa,"
                  "von_mises_depth_um\n";
    sidebands += "variant,torque_Nm,line,mesh_order,pinion_order,gear_order,amplitude_um,phase_deg,aliased\n";
    lines += "variant,torque_Nm,position,phase,pair,z_mm,pinion_roll_angle_deg,load_per_length_N_per_mm,max_"
             "pressure_MPa\n";
    pattern += "# greatest pressure over one mesh cycle, on the pinion's loaded flank\n"
               "variant,torque_Nm,pinion_roll_angle_deg,z_mm,pressure_MPa\n";
    te += "variant,torque_Nm,position,phase,te_um,te_arcsec,contacts,max_pressure_MPa,max_pressure_pinion_"
          "roll_angle_deg,max_pressure_z_mm,"
          "edge_pressure_MPa,mesh_stiffness_N_per_um,secant_stiffness_N_per_um,gear_torque_Nm,max_line_load_"
          "N_per_mm,load_centre_z_mm,"
          "shuttling_moment_Nm,certificate\n";
    spectrum += "variant,torque_Nm,harmonic,amplitude_um,phase_deg,aliased\n";
    pairs += "variant,torque_Nm,position,phase,pair,normal_force_N,load_share,max_pressure_MPa\n";
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const double torque = input.torques[t] / units::newton_metre;
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          {
            const PositionResult &p  = results.at[t][k];
            const double          um = transmission_error_um(pair, p);
            te += fmt::format("0,{:.9g},{},{:.9g},{:.9f},{:.9f},{},{:.4f},{:.6f},{:.6f},{:.4f},{:.6f},{:.6f},"
                              "{:.9g},{:.6f},{:.6f},{:.9f},{:.3e}\n",
                              torque, k, p.phase, um,
                              um * units::micrometre / pair.gear.base_radius / units::arcsecond,
                              p.pairs.size(), p.max_pressure, p.max_pressure_roll / units::degree,
                              p.max_pressure_z, p.edge_pressure, mesh_stiffness(pair, p),
                              um != 0 ? input.torques[t] / pair.pinion.base_radius / um : 0,
                              p.gear_torque / units::newton_metre, p.max_line_load, p.load_centre,
                              p.shuttling_moment / units::newton_metre, p.certificate.worst());
            if (input.torques[t] > 0)
              subsurface +=
                  fmt::format("0,{:.9g},{},{:.9g},{:.4f},", torque, k, p.phase, p.max_pressure) +
                  (p.subsurface.shear > 0
                       ? fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}\n", p.subsurface.shear,
                                     p.subsurface.shear_depth / units::micrometre, p.subsurface.von_mises,
                                     p.subsurface.von_mises_depth / units::micrometre)
                       : ",,,\n"); // loaded at edges alone
            for (const LineLoad &line : p.lines)
              lines += fmt::format("0,{:.9g},{},{:.9g},{},{:.6f},{:.6f},{:.6f},{:.4f}\n", torque, k, p.phase,
                                   line.pair, line.z, line.pinion_roll / units::degree, line.load_per_length,
                                   line.max_pressure);
            double total = 0;
            for (const PairLoad &load : p.pairs)
              total += load.force;
            for (const PairLoad &load : p.pairs)
              pairs += fmt::format("0,{:.9g},{},{:.9g},{},{:.6f},{:.9f},{:.4f}\n", torque, k, p.phase,
                                   load.pair, load.force, load.force / total, load.max_pressure);
          }
        const auto all  = harmonics(errors_over_cycle(pair, results.at[t])),
                   list = mesh_harmonics(all, input.cycles);
        for (std::size_t i = 0; i < list.size(); ++i)
          spectrum += fmt::format("0,{:.9g},{},{:.9f},{:.6f},{}\n", torque, i + 1, list[i].amplitude,
                                  list[i].phase / units::degree,
                                  4 * static_cast<int>(i + 1) > input.positions ? 1 : 0);
        for (std::size_t i = 0; input.cycles > 1 && i < all.size(); ++i)
          {
            const double order = (i + 1.0) / input.cycles;
            sidebands +=
                fmt::format("0,{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9f},{:.6f},{}\n", torque, i + 1, order,
                            order * pair.pinion.teeth, order * pair.gear.teeth, all[i].amplitude,
                            all[i].phase / units::degree, 4 * order > input.positions ? 1 : 0);
          }
        if (input.torques[t] > 0)
          pattern += map_rows(fmt::format("0,{:.9g},", torque),
                              contact_pattern(pair, first_cycle(input, results.at[t]), input.grid.slices), 1);
        if (input.torques[t] > 0 && input.light_load_pattern)
          pattern += map_rows(fmt::format("0,{:.9g},", 0.01 * torque),
                              contact_pattern(pair, results.light[t], input.grid.slices), 1);
      }
    if (any(input.deviations.pinion.modifications) || any(input.deviations.gear.modifications))
      folder.write(
          "modifications.csv",
          "# material removed normal to the flank; sum: where both meet, over the pinion's roll angle\n"
          "flank,roll_angle_deg,z_mm,removed_um\n" +
              map_rows("pinion,", pinion_modification(pair, input.deviations), units::micrometre) +
              map_rows("gear,", gear_modification(pair, input.deviations), units::micrometre) +
              map_rows("sum,", sum_of_modifications(pair, input.deviations), units::micrometre));

    folder.write("results.h5",
                 [&](const std::string &path) { write_hdf5(path, file, input, results, versions); });
    folder.write("te.csv", te);
    folder.write("harmonics.csv", spectrum);
    folder.write("pairs.csv", pairs);
    folder.write("lines.csv", lines);
    folder.write("pattern.csv", pattern);
    if (input.subsurface_stress)
      folder.write("subsurface.csv", subsurface);
    if (input.at_other_level)
      {
        std::string estimate = conventions;
        estimate += fmt::format("# absolute differences of the {} level's results from the {} level's; of "
                                "the finer of the two an upper estimate of "
                                "its "
                                "error\nvariant,torque_Nm,level,compared_with,mean_te_um,te_rms_um,peak_to_"
                                "peak_te_um,A1_um,max_pressure_percent\n",
                                input.level, input.at_other_level->level);
        for (std::size_t t = 0; t < results.error_estimate.size(); ++t)
          {
            const ErrorEstimate &e = results.error_estimate[t];
            estimate +=
                fmt::format("0,{:.9g},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f}\n",
                            input.torques[t] / units::newton_metre, input.level, input.at_other_level->level,
                            e.mean, e.oscillation, e.peak_to_peak, e.first_harmonic, 100 * e.pressure);
          }
        folder.write("error_estimate.csv", estimate);
      }
    if (input.root_stress)
      {
        std::string roots = conventions;
        for (const double torque : input.torques)
          if (torque > 0)
            roots += fmt::format("# at {:.6g} N m", torque / units::newton_metre) +
                     nominal_root_stress(input.pair, torque);
        roots += "# greatest principal stress over the arc of a fillet, tension positive, of the finite "
                 "elements; loaded: below the loaded "
                 "flank\n"
                 "variant,torque_Nm,position,phase,body,pair,fillet,z_mm,tensile_stress_MPa\n";
        for (const RootStress &r : results.root_stress)
          roots += fmt::format("0,{:.9g},{},{:.9g},{},{},{},{:.6f},{:.4f}\n",
                               input.torques[r.torque] / units::newton_metre, r.position,
                               1.0 * r.position / input.positions, r.body == 0 ? "pinion" : "gear", r.pair,
                               r.other_side == 0 ? "loaded" : "other", r.z, r.stress);
        folder.write("root_stress.csv", roots);
      }
    if (input.cycles > 1)
      folder.write("sidebands.csv", sidebands);
    folder.write("case.toml", file.source());
    folder.write("summary.txt", summary(input, results));
  }
} // namespace flank
