// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/results.hpp"

#include "cases/double_roller/pressure_field.hpp"
#include "cases/double_roller/study.hpp"
#include "cases/results/design_torques.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/results/hdf5_file.hpp"
#include "cases/scene.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>

namespace flank
{
  using units::arcsecond;
  using units::degree;

  namespace
  {
    const char *conventions =
        "# TE: lag of the carrier behind crank angle / N_s, positive when the carrier lags; in um at the "
        "sleeve "
        "circle radius R1. With backlash = zero (preset paper)\n"
        "# it is counted from where the most advanced pair touches: LTE = d phi - (phi_d - phi/N_s). Crank "
        "counter-clockwise, carrier clockwise.\n"
        "# max_pressure: at mid-roller. edge_pressure: at the roller's ends; at a straight end the pressure "
        "is "
        "singular and the value depends on the grid.\n"
        "# A_i = 2|c_i| over one period 360/N_r of the crank: TE = mean + sum A_i cos(2 pi i t + phase_deg), "
        "t = "
        "0..1 from the first crank angle.\n";

    double seconds()
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    struct Peaks
    {
      double mid = 0, edge = 0, force = 0;
    };
    Peaks peaks(const DrivePosition &position)
    {
      Peaks p;
      for (const RollerPairLoad &load : position.pairs)
        {
          p.mid   = std::max(p.mid, load.mid_pressure);
          p.edge  = std::max(p.edge, load.edge_pressure);
          p.force = std::max(p.force, load.force);
        }
      return p;
    }

    double micrometres(const DoubleRollerCase &input, const double rotation)
    {
      return rotation * input.drive.sleeve_circle_radius / units::micrometre;
    }

    std::vector<double> lags_um(const DoubleRollerCase &input, const std::vector<DrivePosition> &positions,
                                const std::size_t count)
    {
      std::vector<double> values;
      for (std::size_t i = 0; i < count; ++i)
        values.push_back(micrometres(input, positions[i].lag));
      return values;
    }

    double secant_stiffness(const DoubleRollerCase &input, const DoubleRollerResults &results,
                            const std::size_t t, const std::size_t k)
    {
      const double wound = results.unloaded_psi[k] - results.at[t][k].psi;
      return input.model.input_torque || wound <= 0 ? 0 : input.torques[t] / wound;
    }

    constexpr double per_arcmin = 60 * units::arcsecond / units::newton_metre; // [N mm/rad] to [N m/arcmin]
  }                                                                            // namespace

  std::size_t period_positions(const DoubleRollerCase &input)
  {
    if (input.crank_angles.size() < 2)
      return 0;
    const double exact =
        2 * units::pi / input.drive.rollers / (input.crank_angles[1] - input.crank_angles[0]);
    const auto count = static_cast<std::size_t>(std::lround(exact));
    return std::abs(exact - static_cast<double>(count)) < 1e-6 * exact && count >= 2 &&
                   count <= input.crank_angles.size()
               ? count
               : 0;
  }

  std::vector<std::size_t> map_positions(const DoubleRollerCase &input)
  {
    std::vector<std::size_t> result;
    for (std::size_t k = 0; k < input.crank_angles.size(); ++k)
      if (std::any_of(input.map_angles.begin(), input.map_angles.end(),
                      [&](const double angle) { return std::abs(angle - input.crank_angles[k]) < 1e-9; }))
        result.push_back(k);
    return result;
  }

  StudyPoint study_point(const DoubleRollerCase &input, const DrivePosition &position)
  {
    const double radius = input.drive.sleeve_circle_radius;
    const Peaks  peak   = peaks(position);
    return { micrometres(input, position.lag),
             input.model.input_torque || position.stiffness <= 0
                 ? 0
                 : micrometres(input, units::newton_metre / position.stiffness),
             peak.mid,
             peak.edge,
             position.stiffness / (radius * radius) / units::newton_per_micrometre,
             position.balance,
             static_cast<int>(position.pairs.size()) };
  }

  VariantFrame frame_of(const DoubleRollerCase &input)
  {
    VariantFrame frame;
    for (const double torque : input.torques)
      frame.torques_Nm.push_back(torque / units::newton_metre);
    for (const double angle : input.crank_angles)
      frame.abscissa.push_back(angle / units::degree);
    frame.period = static_cast<int>(period_positions(input));
    return frame;
  }

  std::vector<StudyPoint> study_points(const DoubleRollerCase &input, const DoubleRollerResults &results)
  {
    std::vector<StudyPoint> points;
    for (std::size_t k = 0; k < results.at.front().size(); ++k)
      for (const auto &positions : results.at)
        points.push_back(study_point(input, positions[k]));
    return points;
  }

  double core_seconds(const DoubleRollerCase &input)
  {
    const auto   solves = static_cast<double>(input.crank_angles.size() * input.torques.size());
    const double size   = input.drive.rollers / 18.0; // of the paper's drive, which was measured
    return input.model.conjugate ? 3.0 + 2.6e-3 * solves * size : 0.4 + 2.2e-3 * solves * size;
  }

  double bytes_needed(const DoubleRollerCase &input)
  {
    const double cells = 0.25 * input.grid.across * input.grid.along;
    return 0.04e9 + 3 * 8 * cells * cells +
           static_cast<double>(input.crank_angles.size() * input.torques.size()) *
               (sizeof(DrivePosition) + 10 * sizeof(RollerPairLoad) + 4000);
  }

  DoubleRollerResults run_double_roller(const DoubleRollerCase &input, const LoadedDrive &drive)
  {
    DoubleRollerResults results;
    const double        begin = seconds();
    const auto          n     = input.crank_angles.size();
    results.at.assign(input.torques.size(), std::vector<DrivePosition>(n));
    results.unloaded_psi.resize(n);
    results.preload.resize(n);
    std::atomic<std::size_t> done{ 0 };
    parallel_for(static_cast<int>(n), [&](const int k) {
      const double phi        = input.crank_angles[k];
      results.unloaded_psi[k] = drive.unloaded_psi(phi);
      results.preload[k]      = drive.preload(phi);
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          DrivePosition &p    = results.at[t][k];
          p                   = drive.solve(phi, input.torques[t]);
          p.gear_ratio_secant = degree / ((phi + degree) / drive.drive().sleeves() -
                                          drive.solve(phi + degree, input.torques[t]).lag -
                                          (phi / drive.drive().sleeves() - p.lag));
        }
      if (const std::size_t now = ++done; now % std::max<std::size_t>(1, n / 10) == 0 || now == n)
        spdlog::info("load balance: crank angle {} of {}", now, n);
    });
    results.certificate = drive.laws().worst_certificate();
    results.stage_seconds.emplace_back("pair laws and load balance", seconds() - begin);
    return results;
  }

  std::string summary(const DoubleRollerCase &input, const DoubleRollerResults &results)
  {
    const auto &m = input.model;
    std::string r = fmt::format(
        "{}\ndouble-roller drive: {} rollers, {} sleeves{}; half-space, pairs couple through the rotation; "
        "no finite elements\n"
        "backlash {}; candidates {}; {}gaps {}; torque on the {}; {} cells across, {} along, {}\n\n",
        input.title, input.drive.rollers, input.drive.rollers - 1,
        m.conjugate ? " with the conjugate profile" : "",
        m.backlash == Backlash::exact  ? "exact"
        : m.backlash == Backlash::zero ? "zero"
                                       : "drive flank only",
        m.window ? "window" : "all", m.drop_interfering ? "interfering pairs dropped; " : "",
        m.linear ? "linear" : "exact", m.input_torque ? "crank" : "carrier", input.grid.across,
        input.grid.along, input.grid.uniform ? "uniform" : "automatic");
    r += fmt::format("{:>9} {:>10} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>11} {:>11}\n",
                     "torque", "mean TE", "least", "greatest", "A1", "pairs", "ratio", "ratio", "mid", "edge",
                     "tangent", "secant");
    r += fmt::format("{:>9} {:>10} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>11} {:>11}\n", "N m",
                     "arcsec", "arcsec", "arcsec", "arcsec", "", "least", "greatest", "MPa", "MPa",
                     "N m/arcmin", "N m/arcmin");
    const std::size_t in_period = period_positions(input);
    double            balance   = 0;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        double mean = 0, least = 1e300, greatest = -1e300, slow = 1e300, fast = -1e300, tangent = 0,
               secant   = 0;
        std::size_t few = 1000, many = 0;
        Peaks       worst;
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          {
            const DrivePosition &p     = results.at[t][k];
            const double         ratio = m.secant_ratio ? p.gear_ratio_secant : p.gear_ratio;
            mean += p.lag / static_cast<double>(results.at[t].size());
            least    = std::min(least, p.lag);
            greatest = std::max(greatest, p.lag);
            slow     = std::min(slow, ratio);
            fast     = std::max(fast, ratio);
            tangent += p.stiffness * per_arcmin / static_cast<double>(results.at[t].size());
            secant += secant_stiffness(input, results, t, k) * per_arcmin /
                      static_cast<double>(results.at[t].size());
            few           = std::min(few, p.pairs.size());
            many          = std::max(many, p.pairs.size());
            const Peaks q = peaks(p);
            worst         = { std::max(worst.mid, q.mid), std::max(worst.edge, q.edge), 0 };
            balance       = std::max(balance, p.balance);
          }
        const double a1 = in_period ? harmonics(lags_um(input, results.at[t], in_period))[0].amplitude *
                                          units::micrometre / input.drive.sleeve_circle_radius / arcsecond
                                    : std::nan("");
        r += fmt::format("{:>9.3f} {:>10.4f} {:>10.4f} {:>10.4f} {:>9.4f} {:>9} {:>9.4f} {:>9.4f} {:>9.1f} "
                         "{:>9.1f} {:>11.4f} {:>11.4f}\n",
                         input.torques[t] / units::newton_metre, mean / arcsecond, least / arcsecond,
                         greatest / arcsecond, a1,
                         few == many ? fmt::format("{}", few) : fmt::format("{}..{}", few, many), slow, fast,
                         worst.mid, worst.edge, tangent, secant);
      }
    r += "\n";
    if (input.contact.crown_radius == 0)
      r += "Edge pressures of straight rollers are those of edge cells of a singular pressure: they grow "
           "with the number of cells. "
           "Mid-roller pressures do not.\n";
    r += design_torque_line(frame_of(input), study_points(input, results));
    if (!in_period)
      r += "The crank angles do not divide the period 360/N_r: no harmonics.\n";
    const auto preload = *std::max_element(results.preload.begin(), results.preload.end());
    if (preload > 0)
      r += fmt::format("Unloaded, a pair is pressed with up to {:.2f} N by interference.\n", preload);
    r += fmt::format(
        "certificate: holds; contact of pairs {:.2e}, torque balance of positions {:.2e} (allowed 1e-10)\n",
        results.certificate, balance);
    for (const std::string &warning : input.warnings)
      r += "warning: " + warning + "\n";
    r += conventions;
    for (const auto &[name, time] : results.stage_seconds)
      r += fmt::format("{:<28}{:>8.2f} s\n", name, time);
    return r;
  }

  void write_results(const ResultFolder &folder, const CaseFile &file, const DoubleRollerCase &input,
                     const LoadedDrive &drive, const DoubleRollerResults &results,
                     const std::string &versions)
  {
    const DoubleRollerDrive &kinematics = drive.drive();
    std::string te = conventions, spectrum = conventions, pairs = conventions, unloaded = conventions;
    te += "variant,torque_Nm,position,crank_angle_deg,te_um,te_arcsec,carrier_rotation_deg,gear_ratio,gear_"
          "ratio_instantaneous,gear_ratio_"
          "secant,contacts,max_pressure_MPa,edge_pressure_MPa,"
          "mesh_stiffness_N_per_um,torsional_stiffness_Nm_per_arcmin,torsional_stiffness_secant_Nm_per_"
          "arcmin,certificate\n";
    spectrum += "variant,torque_Nm,harmonic,amplitude_um,phase_deg,aliased\n";
    pairs += "variant,torque_Nm,position,crank_angle_deg,roller,sleeve,flank,normal_force_N,approach_um,"
             "lever_mm,mid_pressure_MPa,edge_"
             "pressure_MPa,greatest_cell_pressure_MPa\n";
    unloaded += "crank_angle_deg,roller,sleeve,flank,contact_rotation_deg,backlash_arcsec,gap_um,lever_mm,"
                "phi_d_deg\n";
    const double      radius    = input.drive.sleeve_circle_radius;
    const std::size_t in_period = period_positions(input);
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const double torque = input.torques[t] / units::newton_metre;
        for (std::size_t k = 0; k < results.at[t].size(); ++k)
          {
            const DrivePosition &p = results.at[t][k];
            const Peaks          q = peaks(p);
            te += fmt::format("0,{:.9g},{},{:.9g},{:.9f},{:.9f},{:.12g},{:.9f},{:.9f},{:.9f},{},{:.4f},{:.4f}"
                              ",{:.6f},{:.9f},{:.9f},{:.3e}\n",
                              torque, k, p.crank_angle / degree, micrometres(input, p.lag), p.lag / arcsecond,
                              p.psi / degree, input.model.secant_ratio ? p.gear_ratio_secant : p.gear_ratio,
                              p.gear_ratio, p.gear_ratio_secant, p.pairs.size(), q.mid, q.edge,
                              p.stiffness / (radius * radius) / units::newton_per_micrometre,
                              p.stiffness * per_arcmin, secant_stiffness(input, results, t, k) * per_arcmin,
                              std::max(p.balance, results.certificate));
            for (const RollerPairLoad &load : p.pairs)
              pairs += fmt::format("0,{:.9g},{},{:.9g},{},{},{},{:.6f},{:.9f},{:.9f},{:.4f},{:.4f},{:.4f}\n",
                                   torque, k, p.crank_angle / degree, load.roller, load.sleeve,
                                   load.lever > 0 ? "drive" : "coast", load.force,
                                   load.approach / units::micrometre, load.lever, load.mid_pressure,
                                   load.edge_pressure, load.max_pressure);
          }
        if (in_period)
          {
            const auto list = harmonics(lags_um(input, results.at[t], in_period));
            for (std::size_t i = 0; i < list.size(); ++i)
              spectrum += fmt::format("0,{:.9g},{},{:.9f},{:.6f},{}\n", torque, i + 1, list[i].amplitude,
                                      list[i].phase / degree, 4 * (i + 1) > in_period ? 1 : 0);
          }
      }
    // Circular sleeves: both flanks of every pair within a quarter pitch of its contact.
    const double near = units::pi / 2 / kinematics.sleeves();
    for (const double phi : input.crank_angles)
      {
        const double nominal = kinematics.nominal_psi(phi);
        double       phi_d = -1e300, phi_c = 1e300; // first of the drive flank, first of the coast flank
        std::string  rows;
        for (const bool write : { false, true })
          for (int n = 1; n <= kinematics.sleeves() && !input.model.conjugate; ++n)
            for (const int k : kinematics.rollers_around(n, phi, nominal))
              for (const DriveFlank flank : { DriveFlank::drive, DriveFlank::coast })
                {
                  const double     rotation = kinematics.contact_rotation(k, n, phi, flank);
                  const RollerPair here     = kinematics.pair(k, n, phi, nominal);
                  if (std::isnan(rotation) || std::abs(rotation - nominal) > near ||
                      (here.lever > 0) != (flank == DriveFlank::drive))
                    continue; // each pair can touch on the flank it is on
                  const RollerPair touching = kinematics.pair(k, n, phi, rotation);
                  if (!write)
                    (flank == DriveFlank::drive ? phi_d : phi_c) =
                        flank == DriveFlank::drive ? std::max(phi_d, rotation) : std::min(phi_c, rotation);
                  if (write)
                    unloaded += fmt::format(
                        "{:.9g},{},{},{},{:.12g},{:.9f},{:.9f},{:.9f},{:.12g}\n", phi / degree, k, n,
                        flank == DriveFlank::drive ? "drive" : "coast", rotation / degree,
                        (flank == DriveFlank::drive ? phi_d - rotation : rotation - phi_c) / arcsecond,
                        here.gap / units::micrometre, touching.lever,
                        (flank == DriveFlank::drive ? phi_d : phi_c) / degree);
                }
      }

    if (input.model.conjugate)
      for (const double phi : input.crank_angles)
        for (const PairPlace &p : drive.pairs(phi, kinematics.nominal_psi(phi)))
          unloaded +=
              fmt::format("{:.9g},{},{},{},{:.12g},0,{:.9f},{:.9f},{:.12g}\n", phi / degree, p.roller,
                          p.sleeve, p.lever > 0 ? "drive" : "coast", kinematics.nominal_psi(phi) / degree,
                          p.gap / units::micrometre, p.lever, kinematics.nominal_psi(phi) / degree);

    folder.write("results.h5", [&](const std::string &path) {
      Hdf5File out;
      out.attribute("title", input.title);
      out.attribute("case_as_given", file.source());
      out.attribute("case_as_resolved", file.resolved());
      out.attribute("versions", versions);
      out.attribute("conventions", conventions);
      std::vector<double> torques, angles;
      for (const double torque : input.torques)
        torques.push_back(torque / units::newton_metre);
      for (const double angle : input.crank_angles)
        angles.push_back(angle / degree);
      out.dataset("", "torque", { torques.size() }, torques, "N m");
      out.dataset("", "crank_angle", { angles.size() }, angles, "deg");
      out.dataset("", "preload", { angles.size() }, results.preload, "N");
      const auto table = [&](const char *name, const char *unit, const auto &value) {
        std::vector<double> values;
        for (const auto &positions : results.at)
          for (const DrivePosition &p : positions)
            values.push_back(value(p));
        out.dataset("", name, { torques.size(), angles.size() }, values, unit, { "torque", "crank_angle" });
      };
      table("transmission_error", "um", [&](const auto &p) { return micrometres(input, p.lag); });
      table("transmission_error_slope", "um/(N m)",
            [&](const auto &p) { return study_point(input, p).te_slope; });
      table("transmission_error_rotation", "arcsec", [&](const auto &p) { return p.lag / arcsecond; });
      table("gear_ratio_instantaneous", "1", [](const auto &p) { return p.gear_ratio; });
      table("gear_ratio_secant", "1", [](const auto &p) { return p.gear_ratio_secant; });
      table("contacts", "1", [](const auto &p) { return static_cast<double>(p.pairs.size()); });
      table("max_pressure", "MPa", [](const auto &p) { return peaks(p).mid; });
      table("edge_pressure", "MPa", [](const auto &p) { return peaks(p).edge; });
      table("torsional_stiffness", "N m/arcmin", [](const auto &p) { return p.stiffness * per_arcmin; });
      table("torque_balance", "relative", [](const auto &p) { return p.balance; });
      for (std::size_t t = 0; t < results.at.size(); ++t)
        for (const std::size_t k : map_positions(input))
          for (const RollerPairLoad &load : results.at[t][k].pairs)
            {
              const PressureMap map   = drive.laws().map(load.sleeve_radius, load.force);
              const std::string group = fmt::format("pressure_maps/torque_{}_position_{}/roller_{}_sleeve_{}",
                                                    t, k, load.roller, load.sleeve);
              const auto column = [&](const char *name, const std::vector<double> &values, const char *unit) {
                out.dataset(group, name, { values.size() }, values, unit);
              };
              column("x", map.x, "mm");
              column("y", map.y, "mm");
              column("half_x", map.half_x, "mm");
              column("half_y", map.half_y, "mm");
              column("pressure", map.pressure, "MPa");
            }
      out.write_to(path);
    });
    if (input.torques.size() > 1)
      design_torques(frame_of(input), study_points(input, results), conventions).write(folder);
    folder.write("unloaded.csv", unloaded);
    folder.write("te.csv", te);
    folder.write("harmonics.csv", spectrum);
    folder.write("pairs.csv", pairs);
    folder.write("case.toml", file.source());
    folder.write("summary.txt", summary(input, results));
  }
} // namespace flank
