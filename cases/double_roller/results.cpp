// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/results.hpp"

#include "cases/double_roller/angle_record.hpp"
#include "cases/double_roller/study.hpp"
#include "cases/double_roller/supports.hpp"
#include "cases/results/design_torques.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/results/hdf5_file.hpp"
#include "cases/results/shown_number.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/memory.hpp"
#include "mesh/base/parallel.hpp"
#include "mesh/base/stage_clock.hpp"
#include "mesh/base/units.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  using units::arcsecond;
  using units::degree;

  namespace
  {
    /// Operations that the load-approach laws take, for each pair of cells of a quarter of a contact: of
    /// circular sleeves, all of which have one law, and of a conjugate profile, whose sleeves have laws for a
    /// ladder of radii. And those of a load balance at one crank angle and torque, for each roller: few of
    /// them carry at once. Fitted by validation/run plan.
    constexpr double of_circles = 1.2e5, of_ladder = 3.0e6, of_pair = 1.5e6;

    /// Memory of a process that has few cells and positions yet (31 MB at the crank angles of exact.toml),
    /// and what a position takes beside its numbers at a torque: that of ten pairs in contact, and what is
    /// packed and written of it. (Together 4.3 kB where two pairs are in contact, from 8000 to 40,000
    /// positions of exact.toml.) [bytes]
    constexpr double bytes_of_process = 0.04e9, pairs_of_position = 10, beside_position = 4000;
  } // namespace

  double operations(const DoubleRollerCase &input, const int processes)
  {
    const double solves =
        static_cast<double>(input.crank_angles.size() * input.torques.size()) / std::max(1, processes);
    const double cells = 0.25 * input.grid.across * input.grid.along; // of a quarter of a pair
    return (input.model.conjugate ? of_ladder : of_circles) * cells * cells +
           of_pair * input.drive.rollers * solves;
  }

  double bytes_needed(const DoubleRollerCase &input)
  {
    const double cells = 0.25 * input.grid.across * input.grid.along;
    return bytes_of_process + 3 * 8 * cells * cells +
           static_cast<double>(input.crank_angles.size() * input.torques.size()) *
               (sizeof(DrivePosition) + pairs_of_position * sizeof(RollerPairLoad) + beside_position);
  }

  namespace
  {
    /// All torques of a case at one crank angle. [rad]
    CrankAngleResult at_angle(const DoubleRollerCase &input, const LoadedDrive &drive, const double phi)
    try
      {
        CrankAngleResult result;
        result.unloaded_psi = drive.unloaded_psi(phi);
        result.preload = drive.preload(phi);
        for (const double torque : input.torques)
          {
            DrivePosition position;
            double ratio = 0;
            std::string failed;
            try
              {
                position = drive.solve(phi, torque);
                ratio = drive.secant_gear_ratio(position);
              }
            catch (const ComputationError &error)
              {
                failed = error.what();
              }
            result.at.push_back(std::move(position));
            result.secant_gear_ratio.push_back(ratio);
            result.failed.push_back(std::move(failed));
          }
        return result;
      }
    catch (const ComputationError &error)
      {
        CrankAngleResult none;
        none.failure = error.what();
        return none;
      }

    /// The crank angles of a case, one a job.
    SharedWork::Jobs angle_jobs(const DoubleRollerCase &input, const LoadedDrive &drive)
    {
      return { .count = static_cast<int>(input.crank_angles.size()),
               .name =
                   [&](const int k) {
                     return fmt::format("load balance, crank angle {} of {}, {} deg", k,
                                        input.crank_angles.size(), input.crank_angles[k] / degree);
                   },
               .run =
                   [&](const int k) {
                     Packer out;
                     pack(at_angle(input, drive, input.crank_angles[k]), out);
                     return std::move(out.result);
                   },
               .sound =
                   [&](const int k, const std::vector<char> &bytes) {
                     return is_angle(bytes, input, input.crank_angles[k]);
                   },
               .done =
                   [](const int finished, const int of) {
                     if (finished % std::max(1, of / 10) == 0 || finished == of)
                       spdlog::info("load balance: crank angle {} of {}", finished, of);
                   } };
    }

    /// Throws the same on all ranks where rank 0 gives a failure. Collective.
    void require_none(const std::string &failure, const SharedWork &work)
    {
      std::vector<char> said(failure.begin(), failure.end());
      if (work.session())
        work.session()->broadcast(said);
      if (!said.empty())
        throw SharedComputationError(std::string(said.begin(), said.end()));
    }
  } // namespace

  DoubleRollerResults run_double_roller(const DoubleRollerCase &input, const LoadedDrive &drive,
                                        const SharedWork &work)
  {
    DoubleRollerResults results;
    StageClock clock;
    std::vector<std::vector<char>> packed = work.run(angle_jobs(input, drive));
    const std::size_t torques = input.torques.size();
    std::vector<std::vector<DrivePosition>> at(torques);
    std::vector<std::vector<double>> ratio(torques);
    std::vector<std::string> failed(torques);
    std::string failure;
    for (std::vector<char> &bytes : packed)
      {
        Unpacker in(bytes);
        CrankAngleResult result = unpack_angle(in);
        bytes = {};
        if (failure = result.failure; !failure.empty())
          break;
        results.unloaded_psi.push_back(result.unloaded_psi);
        results.preload.push_back(result.preload);
        for (std::size_t t = 0; t < torques; ++t)
          {
            at[t].push_back(std::move(result.at[t]));
            ratio[t].push_back(result.secant_gear_ratio[t]);
            if (failed[t].empty())
              failed[t] = result.failed[t];
          }
      }
    for (std::size_t t = 0; t < torques; ++t)
      if (failed[t].empty())
        {
          results.torques.push_back(input.torques[t]);
          results.at.push_back(std::move(at[t]));
          results.secant_gear_ratio.push_back(std::move(ratio[t]));
        }
      else
        results.failures.push_back(
            fmt::format("{:.6g} N m has no results: {}", input.torques[t] / units::newton_metre, failed[t]));
    if (failure.empty() && !packed.empty() && results.torques.empty())
      failure = failed.front();
    require_none(failure, work);
    clock.finished("pair laws and load balance");
    results.stage_seconds = clock.stages();
    return results;
  }

  namespace
  {
    /// A line of the summary's table.
    std::string row_of_torque(const DoubleRollerCase &input, const DoubleRollerResults &results,
                              const std::size_t t)
    {
      double least = 1e300, greatest = -1e300, slow = 1e300, fast = -1e300;
      std::size_t few = 1000, many = 0;
      Peaks worst;
      for (std::size_t k = 0; k < results.at[t].size(); ++k)
        {
          const DrivePosition &p = results.at[t][k];
          const double ratio = gear_ratio(input, results, t, k);
          least = std::min(least, p.lag);
          greatest = std::max(greatest, p.lag);
          slow = std::min(slow, ratio);
          fast = std::max(fast, ratio);
          few = std::min(few, p.pairs.size());
          many = std::max(many, p.pairs.size());
          const Peaks q = peaks(p);
          worst = { std::max(worst.mid, q.mid), std::max(worst.edge, q.edge), 0 };
        }
      const DriveMeans mean = means(input, results, t);
      const VariantFrame frame = frame_of(input);
      const auto in_period = static_cast<std::size_t>(frame.period);
      const double to_arcsec = units::micrometre / input.drive.sleeve_circle_radius / arcsecond,
                   a1 = frame.period >= 2 * frame.order
                            ? to_arcsec *
                                  harmonic_amplitude(lags_um(input, results.at[t], in_period), frame.order)
                            : std::nan("");
      return fmt::format("{:>9} {:>10.4f} {:>10.4f} {:>10.4f} {:>9} {:>9} {:>9.4f} {:>9.4f} {:>9} {:>9} "
                         "{:>11.4f} {:>11.4f}\n",
                         shown_number(input.torques[t] / units::newton_metre, 3), mean.lag / arcsecond,
                         least / arcsecond, greatest / arcsecond,
                         std::isnan(a1) ? "-" : fmt::format("{:.4f}", a1),
                         few == many ? fmt::format("{}", few) : fmt::format("{}..{}", few, many), slow, fast,
                         shown_number(worst.mid, 1), shown_number(worst.edge, 1), mean.tangent * per_arcmin,
                         mean.secant * per_arcmin);
    }
  } // namespace

  namespace
  {
    /// Means over the period of the parts of the transmission error, a line a torque; empty: rigid supports.
    std::string summary_of_shares(const DoubleRollerCase &input, const DoubleRollerResults &results)
    {
      std::string lines;
      for (std::size_t t = 0; input.supports.any() && t < input.torques.size(); ++t)
        if (input.torques[t] > 0)
          {
            const std::string torque = shown_number(input.torques[t] / units::newton_metre, 3);
            const auto mean = [&](const auto &part) {
              return mean_over_period(frame_of(input),
                                      [&](const std::size_t k) { return part(results.at[t][k].shares); }) /
                     arcsecond;
            };
            const double contact = mean([](const LagShares &shares) { return shares.contact; });
            if (std::isnan(contact))
              {
                lines += fmt::format("mean TE at {} N m has no parts: pairs of the coast flank carry too\n",
                                     torque);
                continue;
              }
            lines += fmt::format("mean TE at {} N m in parts: gaps {:.4f}, contact {:.4f}", torque,
                                 mean([](const LagShares &shares) { return shares.gaps; }), contact);
            for (std::size_t k = 0; k < support_parts.size(); ++k)
              if (input.supports.elastic.contains(support_parts[k]))
                lines += fmt::format(", {} {:.4f}", name_of(support_parts[k]),
                                     mean([k](const LagShares &shares) { return shares.support[k]; }));
            lines += " arcsec\n";
          }
      return lines;
    }
  } // namespace

  std::string summary(const DoubleRollerCase &input, const DoubleRollerResults &results)
  {
    const auto &m = input.model;
    std::string r = fmt::format(
        "{}\ndouble-roller drive: {} rollers, {} sleeves{}; half-space, pairs couple through the rotation{}; "
        "no finite elements\n"
        "backlash {}; candidates {}; {}gaps {}; torque on the {}; {} cells across, {} along, {}{}\n",
        input.title, input.drive.rollers, input.drive.rollers - 1,
        m.conjugate ? " with the conjugate profile" : "",
        input.supports.any() ? " and what carries the sleeves" : "",
        m.backlash == Backlash::exact  ? "exact"
        : m.backlash == Backlash::zero ? "zero"
                                       : "drive flank only",
        m.window ? "window" : "all", m.drop_interfering ? "interfering pairs dropped; " : "",
        m.linear ? "linear" : "exact", m.input_torque ? "crank" : "carrier", input.grid.across,
        input.grid.along, input.grid.uniform ? "uniform" : "automatic",
        input.contact.free_ends ? "; ends free" : "");
    r += fmt::format("supports: {}\n\n", described(input.supports));
    r += fmt::format("{:>9} {:>10} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>11} {:>11}\n",
                     "torque", "mean TE", "least", "greatest", "A1", "pairs", "ratio", "ratio", "mid", "edge",
                     "tangent", "secant");
    r += fmt::format("{:>9} {:>10} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>11} {:>11}\n", "N m",
                     "arcsec", "arcsec", "arcsec", "arcsec", "", "least", "greatest", "MPa", "MPa",
                     "N m/arcmin", "N m/arcmin");
    double balance = 0, of_allowed = 0, of_contacts = 0;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        r += row_of_torque(input, results, t);
        for (const DrivePosition &p : results.at[t])
          {
            balance = std::max(balance, p.balance);
            of_allowed = std::max(of_allowed, p.balance_over_allowed);
            of_contacts = std::max(of_contacts, p.certificate);
          }
      }
    r += "\n" + summary_of_shares(input, results);
    if (input.contact.free_ends)
      r += "Edge pressures are finite: the ends of rollers and sleeves are free.\n";
    else if (input.contact.crown_radius == 0)
      r += "Edge pressures of straight rollers are those of edge cells of a singular pressure: they grow "
           "with the number of cells. "
           "Mid-roller pressures do not.\n";
    r += design_torque_line(frame_of(input), study_points(input, results));
    if (period_positions(input) == 0 && pitches_in_period(input.drive) == 1)
      r += "The crank angles do not divide the period 360/N_r: no harmonics.\n";
    const auto preload = *std::max_element(results.preload.begin(), results.preload.end());
    if (preload > 0)
      r += fmt::format("Unloaded, a pair is pressed with up to {:.2f} N by interference.\n", preload);
    r += fmt::format(
        "certificate: holds; contact of pairs {:.2e}, torque balance of positions {:.2e}, at most {:.2g} of "
        "what is allowed (1e-10, or the rounding of the gaps where a torque closes them by as little)\n",
        of_contacts, balance, of_allowed);
    for (const std::string &failed : results.failures)
      r += "failed: " + failed + "\n";
    for (const std::string &warning : input.warnings)
      r += "warning: " + warning + "\n";
    r += drive_conventions;
    for (const auto &[name, time] : results.stage_seconds)
      r += fmt::format("{:<28}{:>8.2f} s\n", name, time);
    return r;
  }
} // namespace flank
