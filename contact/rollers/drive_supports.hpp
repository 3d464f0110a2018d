// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <optional>

namespace flank
{
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
  };

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

  /// Spring constant of a cylindrical roller of steel between its rings, of this effective length [mm]:
  /// ISO/TS 16281. [N/mm^(10/9)]
  double roller_constant(double effective_length);

  /// What carries a drive's sleeves, from the sleeve to the housing. Absent: rigid.
  struct DriveSupports
  {
    std::optional<PinData> pins;    ///< of the carrier, one in each sleeve
    std::optional<Bearing> carrier; ///< between the carrier and the crank's eccentric
    std::optional<Bearing> crank;   ///< between the crank and the housing

    bool any() const { return pins || carrier || crank; }
  };
} // namespace flank
