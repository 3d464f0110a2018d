// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/angle_record.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// The one list of what a record holds of a crank angle.
    template <class Archive, class Result>
    void fields_of_angle(Archive &archive, Result &r)
    {
      archive.fields(r.failure, r.unloaded_psi, r.preload, r.secant_gear_ratio);
      archive.list(r.failed, [](auto &to, auto &why) { to.fields(why); });
      archive.list(r.at, [](auto &to, auto &p) {
        to.fields(p.crank_angle, p.torque, p.psi, p.lag, p.gear_ratio, p.stiffness, p.torque_by_lag,
                  p.balance, p.balance_over_allowed, p.certificate, p.pairs, p.supports, p.shares);
      });
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

    bool is_support(const SupportLoad &support, const int rollers)
    {
      return support.sleeve >= 0 && support.sleeve < rollers && support.part >= support_parts.front() &&
             support.part <= support_parts.back() &&
             are_finite(support.force_x, support.force_y, support.displacement_x, support.displacement_y);
    }

    /// Whether a position is that of a crank angle [rad] and a torque [N mm], and its numbers are.
    bool is_position(const DrivePosition &p, const double crank_angle, const double torque, const int rollers)
    {
      return p.crank_angle == crank_angle && p.torque == torque &&
             are_finite(p.psi, p.lag, p.stiffness, p.torque_by_lag, p.balance, p.balance_over_allowed) &&
             std::all_of(p.supports.begin(), p.supports.end(),
                         [&](const SupportLoad &support) { return is_support(support, rollers); }) &&
             p.certificate >= 0 && std::isfinite(p.certificate) &&
             !std::isnan(p.gear_ratio) && // infinite where the carrier stands still
             std::all_of(p.pairs.begin(), p.pairs.end(),
                         [&](const RollerPairLoad &pair) { return is_pair(pair, rollers); });
    }
  } // namespace

  void pack(const CrankAngleResult &result, Packer &out)
  {
    fields_of_angle(out, result);
  }

  CrankAngleResult unpack_angle(Unpacker &in)
  {
    CrankAngleResult result;
    fields_of_angle(in, result);
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
        return result.at.empty() && result.secant_gear_ratio.empty() && result.failed.empty();
      const std::size_t torques = input.torques.size();
      if (result.at.size() != torques || result.secant_gear_ratio.size() != torques ||
          result.failed.size() != torques || !are_finite(result.unloaded_psi, result.preload))
        return false;
      for (std::size_t t = 0; t < result.at.size(); ++t)
        if (result.failed[t].empty() &&
            (!is_position(result.at[t], crank_angle, input.torques[t], input.drive.rollers) ||
             std::isnan(result.secant_gear_ratio[t])))
          return false;
      return true;
    }
  catch (const UnusableRecord &)
    {
      return false;
    }
} // namespace flank
