// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <array>
#include <map>

namespace flank
{
  /// How a bearing's rings move against each other under a radial force: a spring, or rolling elements that
  /// stand evenly about it, the first along +x, each with the load Q = constant (compression)^exponent, as
  /// ISO/TS 16281 has them.
  struct Bearing
  {
    Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero(); ///< of the spring [N/mm]
    int elements = 0;                                    ///< 0: a spring
    double constant = 0, exponent = 1.5;                 ///< [N/mm^exponent]; balls 3/2, rollers 10/9
    double clearance = 0; ///< radial internal clearance, from side to side [mm]

    Eigen::Vector2d force(const Eigen::Vector2d &displacement) const;   ///< [N] from [mm]
    Eigen::Matrix2d tangent(const Eigen::Vector2d &displacement) const; ///< its derivative [N/mm]
  };

  /// A pin of the carrier, a beam with shear (Timoshenko) of circular section, under the force of its sleeve,
  /// which is spread evenly over the free length. Its ends are clamped. [mm, MPa]
  struct PinData
  {
    enum class Held
    {
      one_end, ///< cantilever
      both_ends
    };
    Held held = Held::one_end;
    double diameter = 0, free_length = 0;
    double youngs_modulus = 0, poissons_ratio = 0;

    /// The mean deflection over the free length under a unit force. Shear coefficient of a circle by Cowper
    /// (1966). [mm/N]
    double compliance() const;

    /// The same as a spring.
    Bearing spring() const;
  };

  /// Spring constant of a cylindrical roller of steel between its rings, of this effective length [mm]:
  /// ISO/TS 16281. [N/mm^(10/9)]
  double roller_constant(double effective_length);

  /// What carries the sleeves, from the sleeve to the housing.
  enum class SupportPart
  {
    needles, ///< between a sleeve and its pin
    pin,     ///< of the carrier, one in each sleeve
    carrier, ///< bearing of the carrier on the crank's eccentric
    crank    ///< bearing of the crank in the housing
  };
  constexpr std::array support_parts = { SupportPart::needles, SupportPart::pin, SupportPart::carrier,
                                         SupportPart::crank };

  /// Whether each sleeve has one of its own.
  constexpr bool is_of_sleeve(const SupportPart part)
  {
    return part == SupportPart::needles || part == SupportPart::pin;
  }

  /// Their laws, each of what lies within it against what lies about it; of needles and pins, of every
  /// sleeve. Absent: rigid.
  struct DriveSupports
  {
    std::map<SupportPart, Bearing> elastic;

    bool any() const { return !elastic.empty(); }
  };
} // namespace flank
