// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/angle_record.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Calls use(member) for every plain member of a position, in one order for both ways.
    template <class Position, class Use>
    void each_plain(Position &p, const Use &use)
    {
      use(p.crank_angle), use(p.torque), use(p.psi), use(p.lag), use(p.gear_ratio), use(p.stiffness);
      use(p.balance), use(p.balance_over_allowed);
    }

    template <class... Values>
    bool are_finite(const Values... values)
    {
      return (std::isfinite(values) && ...);
    }

    /// Whether a pair is of the drive's rollers and sleeves, pressed together, and its numbers are.
    bool is_pair(const RollerPairLoad &pair, const int rollers)
    {
      return pair.roller >= 1 && pair.roller <= rollers && pair.sleeve >= 1 && pair.sleeve < rollers &&
             pair.force >= 0 && pair.approach >= 0 &&
             are_finite(pair.force, pair.approach, pair.max_pressure, pair.mid_pressure, pair.edge_pressure,
                        pair.lever) &&
             !std::isnan(pair.sleeve_radius); // infinite where a conjugate flank is straight
    }

    /// Whether a position is that of a crank angle [rad] and a torque [N mm], and its numbers are.
    bool is_position(const DrivePosition &p, const double crank_angle, const double torque, const int rollers)
    {
      return p.crank_angle == crank_angle && p.torque == torque &&
             are_finite(p.psi, p.lag, p.stiffness, p.balance, p.balance_over_allowed) &&
             !std::isnan(p.gear_ratio) && // infinite where the carrier stands still
             std::all_of(p.pairs.begin(), p.pairs.end(),
                         [&](const RollerPairLoad &pair) { return is_pair(pair, rollers); });
    }
  } // namespace

  void pack(const CrankAngleResult &result, Packer &out)
  {
    out.values(std::vector<char>(result.failure.begin(), result.failure.end()));
    out.value(result.unloaded_psi);
    out.value(result.preload);
    out.value(result.certificate);
    out.values(result.secant_gear_ratio);
    out.value(static_cast<std::int64_t>(result.at.size()));
    for (const DrivePosition &position : result.at)
      {
        each_plain(position, [&](const double value) { out.value(value); });
        out.values(position.pairs);
      }
  }

  CrankAngleResult unpack_angle(Unpacker &in)
  {
    constexpr std::size_t least_bytes = 64; // of a position
    CrankAngleResult result;
    const auto failure = in.values<char>();
    result.failure.assign(failure.begin(), failure.end());
    result.unloaded_psi = in.value<double>();
    result.preload = in.value<double>();
    result.certificate = in.value<double>();
    result.secant_gear_ratio = in.values<double>();
    result.at.resize(in.count(least_bytes));
    for (DrivePosition &position : result.at)
      {
        each_plain(position, [&](double &value) { value = in.value<double>(); });
        position.pairs = in.values<RollerPairLoad>();
      }
    return result;
  }

  bool is_angle(const std::vector<char> &bytes, const DoubleRollerCase &input, const double crank_angle)
  try
    {
      Unpacker in(bytes);
      const CrankAngleResult result = unpack_angle(in);
      if (!in.at_end())
        return false;
      if (!result.failure.empty())
        return result.at.empty() && result.secant_gear_ratio.empty();
      if (result.at.size() != input.torques.size() ||
          result.secant_gear_ratio.size() != input.torques.size() || !(result.certificate >= 0) ||
          !are_finite(result.unloaded_psi, result.preload, result.certificate))
        return false;
      for (std::size_t t = 0; t < result.at.size(); ++t)
        if (!is_position(result.at[t], crank_angle, input.torques[t], input.drive.rollers) ||
            std::isnan(result.secant_gear_ratio[t]))
          return false;
      return true;
    }
  catch (const UnusableRecord &)
    {
      return false;
    }
} // namespace flank
