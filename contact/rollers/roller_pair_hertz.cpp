// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/hertz_stress.hpp"
#include "contact/rollers/roller_pair.hpp"
#include "contact/rollers/sagitta.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  double CrownedRoller::stand_back(const double across, const double along) const
  {
    return sagitta(radius, across) + crown_drop(crown_radius, straight_length, along);
  }

  double RollerPairData::effective_modulus() const
  {
    return half_space::effective_modulus(first.youngs_modulus, first.poissons_ratio, second.youngs_modulus,
                                         second.poissons_ratio);
  }

  RollerPairData::Curvatures RollerPairData::curvatures() const
  {
    // Each roller: 1/R across its axis and that of its crown along it, turned into the first roller's frame.
    const auto of = [](const CrownedRoller &roller, const double angle) {
      const double along =
          roller.crown_radius > 0 && roller.straight_length == 0 ? 1 / roller.crown_radius : 0;
      const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
      return Eigen::Matrix2d(turn * Eigen::Vector2d(1 / roller.radius, along).asDiagonal() *
                             turn.transpose());
    };
    const Eigen::Matrix2d sum = of(first, 0) + of(second, -crossing_angle);
    const double mean = 0.5 * sum.trace(), difference = 0.5 * (sum(0, 0) - sum(1, 1)), twist = sum(0, 1);
    const double radius = std::hypot(difference, twist);
    // Of the greatest curvature, from the x axis (across the first roller); the least one is at right angles
    // to it.
    const double angle = radius > 1e-14 * mean ? 0.5 * std::atan2(twist, difference) : 0;
    return { std::max(0.0, mean - radius), mean + radius, 0.0 - angle };
  }

  double RollerPairData::longest(const double direction) const
  {
    double result = 1e300;
    for (const auto &[roller, angle] :
         { std::pair{ &first, direction }, { &second, direction - crossing_angle } })
      {
        const double along = std::abs(std::cos(angle)), across = std::abs(std::sin(angle));
        result = std::min({ result, along > 0 ? roller->length / 2 / along : result,
                            across > 0 ? roller->radius / across : result });
      }
    return result;
  }

  HertzReference hertz(const RollerPairData &data, const double force)
  {
    if (force == 0)
      return {};
    const auto straight = [](const CrownedRoller &roller) { return roller.crown_radius == 0; };
    const auto round = [](const CrownedRoller &roller) {
      return roller.crown_radius > 0 && roller.straight_length > 0;
    };
    const RollerPairData::Curvatures curvature = data.curvatures();
    HertzReference result;
    const bool parallel = std::abs(std::sin(data.crossing_angle)) < 1e-12; // 180 degrees too
    if (parallel && straight(data.first) && straight(data.second))
      result.line = half_space::hertz_line(1 / curvature.greatest, data.effective_modulus(),
                                           force / std::min(data.first.length, data.second.length));
    else if (round(data.first) || round(data.second))
      result.missing = "a crown has a straight part";
    else if (curvature.least <= 0)
      result.missing = "the rollers do not curve away from each other in all directions";
    else
      {
        const auto ellipse =
            half_space::hertz_ellipse(curvature.least, curvature.greatest, data.effective_modulus(), force);
        if (ellipse.long_half_axis < data.longest(curvature.direction))
          result.ellipse = ellipse;
        else
          result.missing = "the rollers' ends cut Hertz's ellipse";
      }
    const auto below = [&](const auto &contact) {
      result.subsurface =
          half_space::greatest_below(contact, data.first.poissons_ratio, data.second.poissons_ratio);
    };
    if (result.line)
      below(*result.line);
    if (result.ellipse)
      below(*result.ellipse);
    return result;
  }
} // namespace flank
