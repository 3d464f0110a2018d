// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/units.hpp"
#include "mesh/gear/involute.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace flank
{
  enum class Hand
  {
    right,
    left
  };

  /// What a gear is given by. [mm, MPa]; NaN where the value is to be derived.
  struct GearData
  {
    std::string name; ///< "pinion" or "gear": the table in the case file
    int teeth;
    double face_width;
    double tip_radius;
    double root_radius;
    double tooth_thickness; ///< transverse, arc at the reference circle; or NaN, then profile_shift counts
    double profile_shift;   ///< coefficient x, of the normal module
    double bore_radius;
    double fillet_radius;
    double youngs_modulus;
    double poissons_ratio;
    double tip_chamfer =
        0; ///< radial height taken off the tip corner: the flank ends there in a sharp edge [mm]
    double tip_rounding = 0; ///< radius of an arc tangent to the flank and to the tip circle [mm]
  };

  /// Basic data both gears share. [mm, rad]
  struct PairData
  {
    double centre_distance;
    double transverse_module;
    double transverse_pressure_angle;
    double helix_angle; ///< at the reference cylinder, >= 0
    Hand pinion_hand = Hand::right;
    bool counter_clockwise_drive = true; ///< pinion turns counter-clockwise seen from +z
    GearData pinion, gear;
    double axial_offset = 0; ///< z of the gear's mid-face, user's axis; the pinion's is 0 [mm]
  };

  /// What follows from a gear's data and its mate's. Symmetric teeth.
  struct GearGeometry
  {
    double reference_radius, base_radius, base_helix_angle, helix_angle; ///< [mm, rad]
    double half_angle_at_base;                                           ///< psi_b [rad]
    double tip_roll;                                                     ///< of the tip circle [rad]
    double usable_tip_roll; ///< where the involute ends: at the tip circle, the chamfer or the rounding (d_Fa
                            ///< of ISO 21771) [rad]
    double
        form_radius;  ///< where the fillet meets the involute (base circle if it meets the radial line below)
    double form_roll; ///< [rad]
    double tip_thickness; ///< transverse arc at the tip circle [mm]
  };

  struct Gear : GearData, GearGeometry
  {
    InvoluteHelicoid flank() const { return { base_radius, half_angle_at_base, base_helix_angle }; }
    double usable_tip_radius() const { return radius_at_roll(usable_tip_roll, base_radius); }
    double pitch_angle() const { return 2 * units::pi / teeth; }
  };

  /// Roll angles of the mesh's characteristic points on one gear. [rad]
  struct RollAngles
  {
    double start_of_active_profile, lowest_single_contact, pitch_point, highest_single_contact, tip;
  };

  struct GearPair
  {
    PairData data;
    Gear pinion, gear;

    double normal_module, normal_pressure_angle;
    double working_pressure_angle; ///< transverse [rad]
    double base_helix_angle;       ///< [rad]
    double line_of_action;         ///< T1 T2 between the base tangent points [mm]
    double length_of_action;       ///< between the tips' intersections [mm]
    double transverse_base_pitch;  ///< [mm]
    double transverse_contact_ratio, overlap_ratio;
    double common_face_width;                        ///< [mm]
    double face_low, face_high;                      ///< ends of the common face width, user's z [mm]
    double backlash;                                 ///< circumferential, at the working pitch circles [mm]
    double pinion_tip_clearance, gear_tip_clearance; ///< [mm]
    RollAngles pinion_roll, gear_roll;

    /// Things a designer should know that do not stop a run.
    std::vector<std::string> warnings;

    double total_contact_ratio() const { return transverse_contact_ratio + overlap_ratio; }

    /// Roll angle on `gear` where the line of action meets its mate's flank at `mate_roll`:
    /// r_b,1 xi_1 + r_b,2 xi_2 = T1 T2. [rad]
    double facing_roll(const Gear &gear, const Gear &mate, const double mate_roll) const
    {
      return (line_of_action - mate.base_radius * mate_roll) / gear.base_radius;
    }

    /// Roll angle of pair 0's contact on the pinion at mid-face. [rad]
    double contact_roll(const double phase) const
    {
      return std::tan(working_pressure_angle) + phase * pinion.pitch_angle();
    }
  };

  /// Derives and checks everything. Throws InputError (with the quantity) for a pair that cannot be made or
  /// cannot mesh.
  GearPair make_gear_pair(const PairData &data);
} // namespace flank
