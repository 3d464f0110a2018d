// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/placement.hpp"

#include "contact/flanks/mesh_position.hpp"
#include "mesh/base/units.hpp"

namespace flank
{
  namespace
  {
    Eigen::Matrix3d about_z(const double angle)
    {
      return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    }

    /// The placement in the user's frame of a body that is placed in the canonical one, where the pinion is
    /// right-hand and drives counter-clockwise.
    Placement to_user(const GearPair &pair, const Eigen::Matrix3d &turn, const Eigen::Vector3d &offset)
    {
      const Eigen::DiagonalMatrix<double, 3> mirror(1, pair.data.counter_clockwise_drive ? 1 : -1,
                                                    canonical_z_sign(pair.data));
      return { mirror * turn, mirror * offset };
    }
  } // namespace

  Placement pinion_placement(const GearPair &pair, const double phase)
  {
    return to_user(
        pair,
        about_z(pair.contact_roll(phase) - pair.working_pressure_angle - pair.pinion.half_angle_at_base),
        Eigen::Vector3d::Zero());
  }

  Placement gear_placement(const GearPair &pair, const double phase)
  {
    // Towards the pinion, and in z the other way round: its hand is the other one.
    const double roll = pair.facing_roll(pair.gear, pair.pinion, pair.contact_roll(phase));
    const double gear_z = canonical_z_sign(pair.data) * pair.data.axial_offset;
    const double angle = roll - pair.working_pressure_angle - pair.gear.half_angle_at_base -
                         pair.gear.flank().twist() * gear_z;
    return to_user(pair, about_z(units::pi + angle) * Eigen::DiagonalMatrix<double, 3>(1, 1, -1),
                   { pair.data.centre_distance, 0, gear_z });
  }

  Placement of_tooth(const Placement &body, const Gear &gear, const int tooth)
  {
    return { body.turn * about_z(tooth * gear.pitch_angle()), body.offset };
  }
} // namespace flank
