// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/results.hpp"

#include "cases/harmonics.hpp"
#include "cases/parallel_axis/iso_6336.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

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

    const char *conventions = "# TE eps = r_b_pinion theta_pinion + r_b_gear theta_gear along the transverse line of action, both counted "
                              "in the pinion's sense;\n"
                              "# positive when the driven gear lags. te_arcsec: of the driven gear. phase 0: pair 0 at the pitch point at "
                              "mid-face; 1: one pitch on.\n"
                              "# A_i = 2|c_i|: peak amplitude of mesh harmonic i, eps = mean + sum A_i cos(2 pi i phase + phase_deg).\n";
  } // namespace

  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results)
  {
    const GearPair &pair = input.pair;
    std::string     r    = fmt::format(
               "{}\nbody: ring, clamped at the bore (pinion {:.3f} mm, gear {:.3f} mm); {} split; {} positions; {} and {} unknowns a sector\n\n",
               input.title, 2 * pair.pinion.bore_radius, 2 * pair.gear.bore_radius, input.split == Split::projected ? "projected" : "classical",
               input.positions, results.unknowns_pinion, results.unknowns_gear);
    r += fmt::format("{:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n", "torque", "mean TE", "peak-peak",
                     "A1", "A2", "A3", "A4", "A5", "contact", "pressure", "edge", "tangent k", "secant k");
    r += fmt::format("{:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n", "N m", "um", "um", "um", "um",
                     "um", "um", "um", "ratio", "MPa", "MPa", "N/um", "N/um");
    std::vector<std::string> warnings = pair.warnings;
    double                   worst = 0, asymmetry = 0;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const auto  &positions = results.at[t];
        const auto   te        = errors_over_cycle(pair, positions);
        const auto   spectrum  = harmonics(te);
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
        const auto   amplitude = [&](const std::size_t i) { return i < spectrum.size() ? spectrum[i].amplitude : 0; };
        const double secant    = input.torques[t] > 0 ? input.torques[t] / pair.pinion.base_radius / mean : 0;
        r += fmt::format(
            "{:>10.3f} {:>10.4f} {:>10.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>8.3f} {:>9.1f} {:>9.1f} {:>9.2f} {:>9.2f}\n",
            input.torques[t] / units::newton_metre, mean, *std::max_element(te.begin(), te.end()) - *std::min_element(te.begin(), te.end()),
            amplitude(0), amplitude(1), amplitude(2), amplitude(3), amplitude(4), contact, pressure, edge, tangent, secant);
      }
    r += fmt::format("\n{:>10} {:>26} {:>40}\n{:>10} {:>12} {:>12} {:>14} {:>12} {:>12}\n", "torque", "load share of one pair",
                     "where the greatest pressure is", "N m", "least", "greatest", "pinion roll deg", "z mm", "phase");
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      if (input.torques[t] > 0)
        {
          const auto [least, greatest] = load_shares(results.at[t]);
          const auto &peak             = *std::max_element(results.at[t].begin(), results.at[t].end(),
                                                           [](const auto &a, const auto &b) { return a.max_pressure < b.max_pressure; });
          r += fmt::format("{:>10.3f} {:>12.4f} {:>12.4f} {:>14.4f} {:>12.4f} {:>12.4f}\n", input.torques[t] / units::newton_metre, least,
                           greatest, peak.max_pressure_roll / units::degree, peak.max_pressure_z, peak.phase);
          const double deflection = mean_error_um(pair, results.at[t]) * units::micrometre / pair.data.transverse_module;
          if (deflection > 0.05)
            warnings.push_back(fmt::format("at {:.6g} N m the mean transmission error is {:.2g} of the module: small-displacement "
                                           "elasticity is no longer a good model",
                                           input.torques[t] / units::newton_metre, deflection));
        }
    r += "\nPressures in cells at tip edges, cut cells and face ends stand apart (edge): no half-space is there, and they grow as cells "
         "shrink.\n";
    const IsoStiffness iso = iso_6336_stiffness(pair);
    r += fmt::format("ISO 6336-1 method B for comparison: c' {:.2f}, c_gamma_alpha {:.2f}, c_gamma_beta {:.2f} N/(mm um); c_gamma_alpha is "
                     "{:.1f} N/um over the common face width\n",
                     iso.single, iso.mesh, 0.85 * iso.mesh, iso.mesh * pair.common_face_width);
    r += fmt::format(
        "certificate: holds for all {} solutions, worst relative violation {:.2e}; compliance asymmetry before symmetrising up to {:.2e}\n",
        input.torques.size() * input.positions, worst, asymmetry);
    for (const std::string &warning : warnings)
      r += "warning: " + warning + "\n";
    r += conventions;
    for (const auto &[name, time] : results.stage_seconds)
      r += fmt::format("{:<28}{:>8.2f} s\n", name, time);
    return r;
  }

  void write_results(const ResultFolder &folder, const CaseFile &file, const ParallelAxisCase &input, const ParallelAxisResults &results,
                     const std::string &versions)
  {
    const GearPair &pair = input.pair;

    std::string te = conventions, spectrum = conventions, pairs = conventions;
    te += "variant,torque_Nm,position,phase,te_um,te_arcsec,contacts,max_pressure_MPa,max_pressure_pinion_roll_angle_deg,max_pressure_z_mm,"
          "edge_pressure_MPa,mesh_stiffness_N_per_um,secant_stiffness_N_per_um,gear_torque_Nm,certificate\n";
    spectrum += "variant,torque_Nm,harmonic,amplitude_um,phase_deg,aliased\n";
    pairs += "variant,torque_Nm,position,phase,pair,normal_force_N,load_share,max_pressure_MPa\n";
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const double torque = input.torques[t] / units::newton_metre;
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          {
            const PositionResult &p  = results.at[t][k];
            const double          um = transmission_error_um(pair, p);
            te += fmt::format("0,{:.9g},{},{:.9g},{:.9f},{:.9f},{},{:.4f},{:.6f},{:.6f},{:.4f},{:.6f},{:.6f},{:.9g},{:.3e}\n", torque, k,
                              p.phase, um, um * units::micrometre / pair.gear.base_radius / units::arcsecond, p.pairs.size(),
                              p.max_pressure, p.max_pressure_roll / units::degree, p.max_pressure_z, p.edge_pressure,
                              mesh_stiffness(pair, p), um != 0 ? input.torques[t] / pair.pinion.base_radius / um : 0,
                              p.gear_torque / units::newton_metre, p.certificate.worst());
            double total = 0;
            for (const PairLoad &load : p.pairs)
              total += load.force;
            for (const PairLoad &load : p.pairs)
              pairs += fmt::format("0,{:.9g},{},{:.9g},{},{:.6f},{:.9f},{:.4f}\n", torque, k, p.phase, load.pair, load.force,
                                   load.force / total, load.max_pressure);
          }
        const auto list = harmonics(errors_over_cycle(pair, results.at[t]));
        for (std::size_t i = 0; i < list.size(); ++i)
          spectrum += fmt::format("0,{:.9g},{},{:.9f},{:.6f},{}\n", torque, i + 1, list[i].amplitude, list[i].phase / units::degree,
                                  4 * (i + 1) > results.at[t].size() ? 1 : 0);
      }

    folder.write("results.h5", [&](const std::string &path) { write_hdf5(path, file, input, results, versions); });
    folder.write("te.csv", te);
    folder.write("harmonics.csv", spectrum);
    folder.write("pairs.csv", pairs);
    folder.write("case.toml", file.source());
    folder.write("summary.txt", summary(input, results));
  }
} // namespace flank
