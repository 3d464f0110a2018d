// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/drive_position.hpp"

#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace flank
{
  namespace
  {
    constexpr double known_gap = 1e-12; // [mm]
    constexpr double infinity = std::numeric_limits<double>::infinity();
  } // namespace

  LoadedDrive::LoadedDrive(const DriveDefinition &input)
      : input_(input)
      , drive_(input.drive)
      , laws_(input.contact, input.grid)
      , support_balance_(input.supports, drive_.sleeves())
  {
  }

  LoadedDrive::Poses LoadedDrive::poses(const double phi, const double psi, const Shift &shift) const
  {
    return { drive_.pose(phi, psi, shift), drive_.pose(phi, drive_.nominal_psi(phi)) };
  }

  PairPlace LoadedDrive::place(const int roller, const int sleeve, const Poses &stand) const
  {
    const auto &model = input_.model;
    const double phi = stand.here.phi, psi = stand.here.psi, nominal = stand.nominal.psi;
    if (model.conjugate) // the gap stays when crank and carrier turn together
      {
        const ConjugateContact c = drive_.conjugate_contact(roller, phi);
        return { .roller = roller,
                 .sleeve = c.sleeve,
                 .gap = c.lever * (psi - nominal) + input_.drive.clearance,
                 .lever = c.lever,
                 .crank_lever = c.lever / drive_.sleeves(),
                 .sleeve_radius = c.radius };
      }
    const RollerPair at = drive_.pair(roller, sleeve, model.linear ? stand.nominal : stand.here);
    double gap = at.gap;
    if (model.linear)
      gap += at.lever * (psi - nominal);
    if (model.backlash == Backlash::zero)
      gap = at.lever * (psi - nominal);
    return { .roller = roller,
             .sleeve = sleeve,
             .gap = gap,
             .lever = at.lever,
             .crank_lever = at.crank_lever,
             .sleeve_radius = input_.contact.sleeve_radius };
  }

  double LoadedDrive::lever(const PairPlace &pair) const
  {
    return input_.model.input_torque ? pair.crank_lever : pair.lever;
  }

  std::vector<PairPlace> LoadedDrive::pairs(const double phi, const double psi, const Shift &shift) const
  {
    const auto &model = input_.model;
    const double g = drive_.sleeve_pitch();
    const Poses stand = poses(phi, psi);
    std::vector<PairPlace> result;
    if (model.conjugate)
      {
        for (int k = 1; k <= input_.drive.rollers; ++k)
          if (const PairPlace p = place(k, 0, stand); p.lever > 0 || model.backlash == Backlash::exact)
            result.push_back(p);
        return result;
      }
    if (!is_linearised())
      return near_pairs(phi, psi, shift);
    const double near = 0.02 * input_.drive.roller_radius; // what counts as touching in the article
    for (int n = 1; n <= drive_.sleeves(); ++n)
      {
        if (model.window)
          {
            const double angle = std::remainder((n - 0.5) * g - stand.nominal.psi - phi, 2 * units::pi);
            if (!(angle > -g / 2 + 1e-9 && angle < units::pi - 1e-9))
              continue;
            RollerPair nearest{ .roller = 0, .sleeve = 0, .gap = 1e300, .lever = 0, .crank_lever = 0 };
            for (const int k : drive_.rollers_around(n, stand.nominal))
              if (const RollerPair p = drive_.pair(k, n, stand.nominal); p.lever > 0 && p.gap < nearest.gap)
                nearest = p;
            if (nearest.roller > 0 && !(model.drop_interfering && nearest.gap < 0))
              result.push_back(place(nearest.roller, n, stand));
            continue;
          }
        for (const int k : drive_.rollers_around(n, stand.nominal))
          {
            const RollerPair p = drive_.pair(k, n, stand.nominal);
            if ((model.drop_interfering && p.gap < 0) || (model.backlash != Backlash::exact && p.lever <= 0))
              continue;
            if (model.backlash == Backlash::zero && p.gap > near)
              continue;
            result.push_back(place(k, n, stand));
          }
      }
    return result;
  }

  bool LoadedDrive::is_linearised() const
  {
    return input_.model.linear || input_.model.window || input_.model.backlash == Backlash::zero;
  }

  /// Pairs by where they are at this rotation, however far that is from the nominal one.
  std::vector<PairPlace> LoadedDrive::near_pairs(const double phi, const double psi, const Shift &shift) const
  {
    const auto &model = input_.model;
    const Poses stand = poses(phi, psi, shift);
    std::vector<PairPlace> result;
    for (int n = 1; n <= drive_.sleeves(); ++n)
      for (const int k : drive_.rollers_around(n, stand.here))
        {
          const PairPlace p = place(k, n, stand);
          const bool coasts = p.lever <= 0 && model.backlash != Backlash::exact,
                     interferes = model.drop_interfering && drive_.pair(k, n, stand.nominal).gap < 0;
          if (!coasts && !interferes)
            result.push_back(p);
        }
    return result;
  }

  void LoadedDrive::require_all_pairs(const DrivePosition &position, const Shift &shift) const
  {
    const auto &model = input_.model;
    if (is_linearised() || model.conjugate || model.drop_interfering || model.backlash != Backlash::exact)
      return;
    const DoubleRollerDrive::Pose pose = drive_.pose(position.crank_angle, position.psi, shift);
    std::size_t overlapping = 0;
    for (int n = 1; n <= drive_.sleeves(); ++n)
      {
        const Eigen::Vector2d sleeve = drive_.sleeve_centre_at(n, pose);
        for (int k = 1; k <= input_.drive.rollers; ++k)
          overlapping += (drive_.roller_centre(k) - sleeve).norm() <
                         drive_.roller_radius(k) + drive_.sleeve_radius(n) - 10 * known_gap;
      }
    if (overlapping > position.pairs.size())
      throw ComputationError(fmt::format(
          "at crank angle {:.4f} deg, torque {:.6g} N m {} of roller and sleeve overlap and only {} of "
          "them carry: the sleeves are past rollers that should have held them",
          position.crank_angle / units::degree, position.torque / units::newton_metre,
          counted(overlapping, "pair"), position.pairs.size()));
  }

  LoadedDrive::Sum LoadedDrive::sum(const double phi, const double psi) const
  {
    Sum result{ .torque = 0, .slope = 0, .greatest = 0 };
    for (const PairPlace &p : pairs(phi, psi))
      if (p.gap < 0)
        {
          const PairState s = laws_.load_at(p.sleeve_radius, -p.gap);
          result.torque += lever(p) * s.force;
          result.slope += lever(p) * s.stiffness * p.lever;
          result.greatest = std::max(result.greatest, std::abs(lever(p) * s.force));
        }
    return result;
  }

  LoadedDrive::Sum LoadedDrive::sum_or_beyond(const double phi, const double psi) const
  {
    try
      {
        return sum(phi, psi);
      }
    catch (const BeyondHalfSpace &)
      {
        return { .torque = infinity, .slope = 0, .greatest = infinity };
      }
  }

  double LoadedDrive::find_psi(const double phi, const double torque) const
  {
    // The balance falls as psi grows. Bracket outwards from where the drive flank first touches, or from the
    // nominal rotation where pairs overlap there, then Newton held by bisection. A rotation at which some
    // contact is too wide for the half-space carries more than any other.
    const double nominal = drive_.nominal_psi(phi), farthest = farthest_lag(),
                 longest = farthest / 64; // step: a pair that opens again while the next one closes is seen
    const auto excess = [&](const double psi) { return sum_or_beyond(phi, psi).torque - torque; };
    const double touch = drive_touch(phi),
                 start = touch > -infinity && touch < nominal && excess(nominal) < 0 && excess(touch) < 0
                             ? touch
                             : nominal;
    double low = start, high = start, step = 1e-7;
    if (excess(start) < 0)
      while (excess(low) < 0)
        {
          high = low;
          low -= step;
          step = std::min(2 * step, longest);
          if (start - low > farthest)
            throw ComputationError(fmt::format(
                "no equilibrium at crank angle {:.4f} deg, torque {:.6g} N m: no rotation of the carrier up "
                "to {:.3g} deg behind the nominal one or its first touch carries it",
                phi / units::degree, torque / units::newton_metre, farthest / units::degree));
        }
    else
      while (excess(high) >= 0)
        {
          low = high;
          high += step;
          step = std::min(2 * step, longest);
          if (high - start > farthest)
            throw ComputationError(fmt::format(
                "no equilibrium at crank angle {:.4f} deg, torque {:.6g} N m: nothing holds the carrier up "
                "to {:.3g} deg ahead of the nominal rotation",
                phi / units::degree, torque / units::newton_metre, farthest / units::degree));
        }
    double psi = 0.5 * (low + high);
    for (int i = 0; i < 200; ++i)
      {
        const Sum s = sum_or_beyond(phi, psi);
        (s.torque >= torque ? low : high) = psi;
        if (std::abs(s.torque - torque) <= 1e-14 * std::max(std::abs(torque), s.greatest) ||
            high - low <= 1e-18)
          break;
        const double next = s.slope > 0 ? psi + (s.torque - torque) / s.slope : low - 1;
        const double chosen = next > low && next < high ? next : 0.5 * (low + high);
        if (chosen == psi)
          break;
        psi = chosen;
      }
    sum(phi, psi); // says why, where the half-space ends before the torque is carried
    return psi;
  }

  double LoadedDrive::farthest_lag() const
  {
    return units::pi / 2 / drive_.sleeves();
  }

  double LoadedDrive::drive_touch(const double phi) const
  {
    const double nominal = drive_.nominal_psi(phi);
    double touch = -infinity;
    for (const PairPlace &p : pairs(phi, nominal))
      if (p.lever > 1e-6)
        touch = std::max(touch, input_.model.linear || input_.model.conjugate ||
                                        input_.model.backlash == Backlash::zero
                                    ? nominal - p.gap / p.lever
                                    : drive_.contact_rotation(p.roller, p.sleeve, phi, DriveFlank::drive));
    return touch;
  }

  double LoadedDrive::unloaded_psi(const double phi) const
  {
    return unloaded(phi).psi;
  }

  SupportState LoadedDrive::unloaded(const double phi) const
  {
    const double touch = drive_touch(phi);
    if (touch == -infinity)
      return { .psi = drive_.nominal_psi(phi) };
    // Free at first touch: that is it; else the overlapping pairs find their balance.
    const auto at_touch = pairs(phi, touch);
    const double overlap =
        std::accumulate(at_touch.begin(), at_touch.end(), 0.0,
                        [](const double most, const PairPlace &p) { return std::max(most, -p.gap); });
    return overlap < known_gap ? SupportState{ .psi = touch } : balance(phi, 0);
  }

  double LoadedDrive::preload(const double phi) const
  {
    double greatest = 0;
    const SupportState state = unloaded(phi);
    for (const PairPlace &p : pairs(phi, state.psi, support_balance_.shift(state)))
      if (p.gap < -known_gap)
        greatest = std::max(greatest, laws_.at_approach(p.sleeve_radius, -p.gap).force);
    return greatest;
  }

  /// Carrier rotation at which the most advanced pair touches. [rad] The double-roller actuator article
  /// (bibliography in contact/bibliography.md) counts its LTE from there: d phi - (phi_d - phi/N_s).
  double LoadedDrive::first_touch(const double phi) const
  {
    double touch = -1e300;
    for (const PairPlace &p : pairs(phi, drive_.nominal_psi(phi)))
      if (const double rotation = drive_.contact_rotation(p.roller, p.sleeve, phi, DriveFlank::drive);
          !std::isnan(rotation))
        touch = std::max(touch, rotation);
    return touch;
  }

  double LoadedDrive::secant_gear_ratio(const DrivePosition &position) const
  {
    const double phi = position.crank_angle, step = units::degree,
                 here = phi / drive_.sleeves() - position.lag,
                 there = (phi + step) / drive_.sleeves() - solve(phi + step, position.torque).lag;
    return step / (there - here);
  }

  LoadedDrive::Rates LoadedDrive::rates(const PairPlace &p, const PairState &s, const double phi,
                                        const double psi, const Shift &shift) const
  {
    // Of what the model says, by central differences: it is smooth, and they are good to 1e-9.
    constexpr double h = 1e-5;
    const PairPlace ahead = place(p.roller, p.sleeve, poses(phi + h, psi, shift)),
                    behind = place(p.roller, p.sleeve, poses(phi - h, psi, shift)),
                    turned = place(p.roller, p.sleeve, poses(phi, psi + h, shift)),
                    back = place(p.roller, p.sleeve, poses(phi, psi - h, shift));
    const double gap_by_phi = (ahead.gap - behind.gap) / (2 * h),
                 gap_by_psi = (turned.gap - back.gap) / (2 * h);
    Rates result;
    result.stiffness = p.lever * s.stiffness * gap_by_psi - s.force * (turned.lever - back.lever) / (2 * h);
    const double l = lever(p);
    result.by_psi = l * s.stiffness * gap_by_psi - s.force * (lever(turned) - lever(back)) / (2 * h);
    result.by_phi = s.force * (lever(ahead) - lever(behind)) / (2 * h) - l * s.stiffness * gap_by_phi;
    if (ahead.sleeve_radius != behind.sleeve_radius) // along the conjugate profile
      result.by_phi += l *
                       (laws_.load_at(ahead.sleeve_radius, -p.gap).force -
                        laws_.load_at(behind.sleeve_radius, -p.gap).force) /
                       (2 * h);
    return result;
  }

  LoadedDrive::Balance LoadedDrive::load_pairs(DrivePosition &position, const Shift &shift) const
  {
    Balance sum;
    const std::vector<PairPlace> near = pairs(position.crank_angle, position.psi, shift);
    const auto closed_by = [&](const double approach) {
      return [approach](const PairPlace &p) { return p.gap < -approach; };
    };
    // A torque may be too light to close any pair by more than rounding does: then what it closes counts.
    const double least =
        position.torque != 0 && std::none_of(near.begin(), near.end(), closed_by(known_gap)) ? 0 : known_gap;
    for (const PairPlace &p : near)
      {
        if (!closed_by(least)(p))
          continue;
        const PairState s = laws_.at_approach(p.sleeve_radius, -p.gap);
        position.pairs.push_back({ .roller = p.roller,
                                   .sleeve = p.sleeve,
                                   .force = s.force,
                                   .approach = -p.gap,
                                   .max_pressure = s.max_pressure,
                                   .mid_pressure = s.mid_pressure,
                                   .edge_pressure = s.edge_pressure,
                                   .lever = p.lever,
                                   .sleeve_radius = p.sleeve_radius });
        position.certificate = std::max(position.certificate, s.certificate);
        const Rates of_pair = rates(p, s, position.crank_angle, position.psi, shift);
        position.stiffness += of_pair.stiffness;
        sum.by_psi += of_pair.by_psi;
        sum.by_phi += of_pair.by_phi;
        const double l = lever(p);
        sum.moment += l * s.force;
        sum.sensitivity += std::abs(l) * s.stiffness;
        sum.greatest = std::max(sum.greatest, std::abs(l * s.force));
      }
    return sum;
  }

  void LoadedDrive::require_balance(DrivePosition &position, const Balance &sum) const
  {
    const double torque = position.torque, degrees = position.crank_angle / units::degree;
    if (torque != 0 && position.pairs.empty())
      throw ComputationError(fmt::format(
          "at crank angle {:.4f} deg the torque {:.6g} N m closes its pairs by less than {:.1g} mm, to which "
          "their gaps are known: give 0, or a torque that can be told from it",
          degrees, torque / units::newton_metre, known_gap));
    const double scale = std::max(std::abs(torque), sum.greatest);
    position.balance = scale > 0 ? std::abs(sum.moment - torque) / scale : 0;
    // What the rounding of the gaps, distances of some R, lets the forces vary by: felt at torques of newton
    // millimetres.
    const double rounding =
        10 * std::numeric_limits<double>::epsilon() * input_.drive.roller_circle_radius * sum.sensitivity;
    const double allowed = std::max(1e-10, scale > 0 ? rounding / scale : 0);
    position.balance_over_allowed = position.balance / allowed;
    if (!(position.balance <= allowed))
      throw ComputationError(
          fmt::format("torque balance {:.3g} at crank angle {:.4f} deg, torque {:.6g} N m: allowed is {:.3g}",
                      position.balance, degrees, torque / units::newton_metre, allowed));
  }

  DrivePosition LoadedDrive::solve(const double phi, const double torque) const
  {
    DrivePosition result;
    result.crank_angle = phi;
    result.torque = torque;
    const SupportState state = torque == 0 ? unloaded(phi) : balance(phi, torque);
    result.psi = state.psi;
    const Shift shift = support_balance_.shift(state);
    Balance sum = load_pairs(result, shift);
    condense(result, state, sum);
    require_balance(result, sum);
    result.balance = std::max(result.balance, state.balance);
    result.balance_over_allowed = std::max(result.balance_over_allowed, state.balance_over_allowed);
    require_all_pairs(result, shift);
    const double nominal = drive_.nominal_psi(phi);
    result.lag = nominal - result.psi;
    result.torque_by_lag = sum.by_psi; // at one crank angle psi falls as the lag grows
    if (input_.model.backlash == Backlash::zero && !input_.model.conjugate)
      if (const double touch = first_touch(phi); touch > -1e300)
        result.lag -= touch - nominal;
    tell_supports(result, state);
    constexpr double h = 1e-5; // of the crank, where nothing is loaded: the ratio of the touching surfaces
    result.gear_ratio =
        sum.by_psi > 0 ? sum.by_psi / sum.by_phi : 2 * h / (unloaded_psi(phi + h) - unloaded_psi(phi - h));
    return result;
  }

  Eigen::Vector2d LoadedDrive::towards_sleeve(const int roller, const int sleeve, const double crank_angle,
                                              const double psi) const
  {
    if (input_.model.conjugate)
      return Eigen::Rotation2Dd(-psi) * -drive_.conjugate_contact(roller, crank_angle).normal;
    return (drive_.sleeve_centre_at(sleeve, drive_.pose(crank_angle, psi)) - drive_.roller_centre(roller))
        .normalized();
  }
} // namespace flank
