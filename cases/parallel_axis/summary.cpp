// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/conventions.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/results.hpp"
#include "cases/results/design_torques.hpp"
#include "cases/results/shown_number.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "contact/solve/conditioning.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace flank
{
  namespace
  {
    /// Least and greatest share of the normal force that one loaded tooth pair carries over the cycle.
    std::pair<double, double> load_shares(const std::vector<PositionResult> &positions)
    {
      double least = 1, greatest = 0;
      for (const PositionResult &position : positions)
        for (const PairLoad &load : position.pairs)
          {
            least = std::min(least, load_share(position, load));
            greatest = std::max(greatest, load_share(position, load));
          }
      return { least, greatest };
    }

    std::string bodies_line(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      const GearPair &pair = input.pair;
      return fmt::format(
          "{}\nbody: {} (bore: pinion {:.3f} mm, gear {:.3f} mm); {} split; {} positions{}; {} and {} "
          "unknowns a sector\n\n",
          input.title, input.body.describe(), 2 * pair.pinion.bore_radius, 2 * pair.gear.bore_radius,
          input.near_field.split == Split::projected ? "projected" : "classical", input.positions,
          input.cycles > 1 ? fmt::format(" in each of {} mesh cycles", input.cycles) : "",
          results.unknowns_pinion, results.unknowns_gear);
    }

    std::string transmission_errors(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      const GearPair &pair = input.pair;
      std::string r =
          fmt::format("{:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n",
                      "torque", "mean TE", "peak-peak", "A1", "A2", "A3", "A4", "A5", "contact", "pressure",
                      "tip edge", "tangent k", "secant k");
      r += fmt::format("{:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n",
                       "N m", "um", "um", "um", "um", "um", "um", "um", "ratio", "MPa", "N/mm", "N/um",
                       "N/um");
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const auto &positions = results.at[t];
          const auto te = errors_over_cycle(pair, positions);
          const auto spectrum = mesh_harmonics(harmonics(te), input.cycles);
          const double mean = mean_error_um(pair, positions);
          double contact = 0, edge = 0, tangent = 0;
          for (const PositionResult &p : positions)
            {
              contact += static_cast<double>(p.pairs.size()) / positions.size();
              edge = std::max(edge, p.tip_edge_load);
              tangent += tangent_stiffness(pair, p) / units::newton_per_micrometre / positions.size();
            }
          const double noise = noise_of_harmonics(te);
          const auto amplitude = [&](const std::size_t i) {
            if (i >= spectrum.size())
              return std::string("-");
            const double value = spectrum[i].amplitude;
            return value < noise && value > 0 ? fmt::format("<{:.4f}", noise) : fmt::format("{:.4f}", value);
          };
          const double secant = input.torques[t] > 0 ? secant_stiffness(pair, input.torques[t], mean) : 0;
          r += fmt::format("{:>10} {:>10.4f} {:>10.4f} {:>8} {:>8} {:>8} {:>8} {:>8} "
                           "{:>8.3f} {:>9} {:>9} {:>9.2f} {:>9.2f}\n",
                           shown_torque(input.torques[t]), mean,
                           *std::max_element(te.begin(), te.end()) - *std::min_element(te.begin(), te.end()),
                           amplitude(0), amplitude(1), amplitude(2), amplitude(3), amplitude(4), contact,
                           shown_pressure(positions), shown_number(edge, 1), tangent, secant);
        }
      return r;
    }

    std::string loads(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      std::string r = fmt::format(
          "\n{:>10} {:>26} {:>40} {:>9} {:>9} {:>9} {:>19}\n{:>10} {:>12} {:>12} {:>14} {:>12} {:>12} {:>9} "
          "{:>9} {:>9} {:>9} {:>9}\n",
          "torque", "load share of one pair", "where the greatest pressure is", "line load", "K_Hbeta",
          "flank", "shuttling moment", "N m", "least", "greatest", "pinion roll deg", "z mm", "phase", "N/mm",
          "", "used %", "mean N m", "p-p N m");
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        if (input.torques[t] > 0)
          {
            const auto [least, greatest] = load_shares(results.at[t]);
            const auto &peak = *std::max_element(
                results.at[t].begin(), results.at[t].end(),
                [](const auto &a, const auto &b) { return a.max_pressure < b.max_pressure; });
            double line_load = 0, mean_moment = 0, low_moment = 1e300, high_moment = -1e300;
            for (const PositionResult &p : results.at[t])
              {
                line_load = std::max(line_load, p.max_line_load);
                mean_moment += p.shuttling_moment / results.at[t].size();
                low_moment = std::min(low_moment, p.shuttling_moment);
                high_moment = std::max(high_moment, p.shuttling_moment);
              }
            const auto cycle = first_cycle(input, results.at[t]);
            r += fmt::format(
                "{:>10} {:>12.4f} {:>12.4f} {:>14.4f} {:>12.4f} {:>12.4f} {:>9} {:>9.4f} "
                "{:>9.1f} {:>9.4f} {:>9.4f}\n",
                shown_torque(input.torques[t]), least, greatest, peak.max_pressure_roll / units::degree,
                peak.max_pressure_z, peak.phase, shown_number(line_load, 1),
                face_load_factor(input.pair, cycle, input.grid.slices),
                100 * covered_share(contact_pattern(input.pair, cycle, input.grid.slices)),
                mean_moment / units::newton_metre, (high_moment - low_moment) / units::newton_metre);
          }
      return r;
    }

    /// What has no greatest pressure, if anything does: where it stands; of sharp face ends and tip
    /// edges the greatest intensity of each power.
    std::string edges(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      const auto carries = [](const PositionResult &p) { return p.edge_pressure > 0 || p.tip_edge_load > 0; };
      if (std::ranges::none_of(
              results.at, [&](const auto &positions) { return std::ranges::any_of(positions, carries); }))
        return {};
      std::string r =
          "\nAt tip edges and sharp face ends pressure has no limit: what cells see there is in te.csv "
          "(edge_pressure_MPa), not above.\ntip edge: the greatest force per length of a tip edge beyond "
          "the path of action, 5 % of the face away from its ends.\n";
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          std::map<std::pair<std::string, double>, double> greatest; // of an edge and its power
          const auto add = [&](const std::string &edge, const double intensity, const double power) {
            if (intensity > 0)
              greatest[{ edge, -power }] = std::max(greatest[{ edge, -power }], intensity);
          };
          for (const PositionResult &p : results.at[t])
            {
              add("sharp face end", p.end_intensity, p.end_power);
              add("sharp tip edge", p.tip_intensity, p.tip_power);
            }
          for (const auto &[edge, intensity] : greatest)
            r += fmt::format(
                "{} at {} N m: pressure comes to {:.4f} MPa times (1 mm over the distance) to the "
                "power {:.6f}\n",
                edge.first, shown_torque(input.torques[t]), intensity, edge.second);
        }
      return r;
    }

    /// What the results themselves give reason to doubt.
    std::vector<std::string> doubts(const ParallelAxisCase &input, const ParallelAxisResults &results)
    {
      std::vector<std::string> found;
      for (std::size_t t = 0; t < input.torques.size(); ++t)
        {
          const double torque = input.torques[t] / units::newton_metre;
          const double deflection = mean_error_um(input.pair, results.at[t]) * units::micrometre /
                                    input.pair.data.transverse_module;
          if (input.torques[t] > 0 && deflection > 0.05)
            found.push_back(fmt::format("at {:.6g} N m the mean transmission error is {:.2g} of the module: "
                                        "small-displacement elasticity is no longer a good model",
                                        torque, deflection));
          const auto on_one_slice = std::count_if(results.at[t].begin(), results.at[t].end(),
                                                  [](const auto &p) { return p.lines.size() == 1; });
          if (on_one_slice > 0)
            found.push_back(fmt::format(
                "at {:.6g} N m the whole load stands on one of {} slices at {} of {} positions: the slices "
                "do "
                "not resolve such a contact, and its transmission error and pressure depend on their number "
                "(contact_grid.slices)",
                torque, input.grid.slices, on_one_slice, results.at[t].size()));
        }
      return found;
    }

    /// The elements' part is what the flanks' nodes yield by, the finite-element operator reduced to them.
    std::string conditioning_line(const double contact, const ParallelAxisResults &results)
    {
      double elements = 0;
      for (const auto &body : results.bodies)
        elements = std::max(elements, condition(body->far_field().by_tooth_offset.front()));
      return fmt::format("condition: compliance of the loaded cells up to {:.1e}, of the flanks' elements "
                         "{:.1e}; rounding reaches {:.0e} of the forces\n",
                         contact, elements,
                         std::max(contact, elements) * std::numeric_limits<double>::epsilon());
    }
  } // namespace

  std::string summary(const ParallelAxisCase &input, const ParallelAxisResults &results,
                      const std::vector<ExtraOutput> &extras)
  {
    std::string r = bodies_line(input, results) + transmission_errors(input, results) +
                    loads(input, results) + edges(input, results);
    r += design_torque_line(frame_of(input), study_points(input, results));
    for (const ExtraOutput &extra : extras)
      r += extra.summary;
    const IsoStiffness iso = iso_6336_stiffness(input.pair);
    r += fmt::format("ISO 6336-1 method B for comparison: c' {:.2f}, c_gamma_alpha {:.2f}, c_gamma_beta "
                     "{:.2f} N/(mm um); c_gamma_alpha is {:.1f} N/um over the common face width\n",
                     iso.single, iso.mesh, iso.mesh_beta(), iso.mesh * input.pair.common_face_width);
    double worst = 0, asymmetry = 0, contact = 0;
    for (const auto &positions : results.at)
      for (const PositionResult &p : positions)
        {
          worst = std::max(worst, p.certificate.worst());
          asymmetry = std::max(asymmetry, p.asymmetry);
          contact = std::max(contact, p.condition);
        }
    const auto loaded = std::ranges::count_if(input.torques, [](const double t) { return t > 0; });
    r += fmt::format("certificate: holds for all {} solutions, worst relative violation {:.2e}; compliance "
                     "asymmetry before symmetrising up to {:.2e}\n",
                     loaded * input.positions * input.cycles, worst, asymmetry);
    r += conditioning_line(contact, results);
    for (const std::string &failure : input.failures)
      r += "failed: " + failure + "\n";
    for (const auto &warnings : { input.pair.warnings, doubts(input, results) })
      for (const std::string &warning : warnings)
        r += "warning: " + warning + "\n";
    r += conventions;
    for (const auto &[name, time] : results.stage_seconds)
      r += fmt::format("{:<68}{:>8.2f} s\n", name, time);
    return r;
  }
} // namespace flank
