// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/drive_supports.hpp"

#include "mesh/base/units.hpp"

#include <cmath>

namespace flank
{
  using units::pi;

  double PinData::compliance() const
  {
    const double area = pi / 4 * diameter * diameter, inertia = pi / 64 * std::pow(diameter, 4),
                 bending = youngs_modulus * inertia, nu = poissons_ratio,
                 shear = 6 * (1 + nu) / (7 + 6 * nu) * youngs_modulus / (2 * (1 + nu)) * area,
                 cube = std::pow(free_length, 3);
    return held == Held::one_end ? cube / (20 * bending) + free_length / (3 * shear)
                                 : cube / (720 * bending) + free_length / (12 * shear);
  }

  Bearing PinData::spring() const
  {
    return { .stiffness = Eigen::Matrix2d::Identity() / compliance() };
  }

  double roller_constant(const double effective_length)
  {
    return 35948 * std::pow(effective_length, 8.0 / 9);
  }

  namespace
  {
    /// Calls use(direction, compression) for each rolling element that is pressed.
    template <class Use>
    void each_pressed(const Bearing &bearing, const Eigen::Vector2d &displacement, const Use &use)
    {
      for (int k = 0; k < bearing.elements; ++k)
        {
          const double angle = 2 * pi * k / bearing.elements;
          const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
          const double compression = displacement.dot(direction) - bearing.clearance / 2;
          if (compression > 0)
            use(direction, compression);
        }
    }
  } // namespace

  Eigen::Vector2d Bearing::force(const Eigen::Vector2d &displacement) const
  {
    Eigen::Vector2d sum = stiffness * displacement;
    each_pressed(*this, displacement, [&](const Eigen::Vector2d &direction, const double compression) {
      sum += constant * std::pow(compression, exponent) * direction;
    });
    return sum;
  }

  Eigen::Matrix2d Bearing::tangent(const Eigen::Vector2d &displacement) const
  {
    Eigen::Matrix2d sum = stiffness;
    each_pressed(*this, displacement, [&](const Eigen::Vector2d &direction, const double compression) {
      sum += constant * exponent * std::pow(compression, exponent - 1) * direction * direction.transpose();
    });
    return sum;
  }
} // namespace flank
