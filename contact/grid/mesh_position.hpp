// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/grid/patch.hpp"
#include "mesh/gear/gear_pair.hpp"
#include "mesh/gear/microgeometry.hpp"

namespace flank
{
  /// The pair in the canonical frame: pinion right-hand and driving counter-clockwise; z = z_sign * the user's z.
  /// Every other hand and direction of drive is a mirror image with the same transmission error.
  double canonical_z_sign(const PairData &data);

  /// A strip of the face width of one tooth pair at one mesh position, placed by closest approach of the true surfaces.
  struct Slice
  {
    int    pair;                   ///< tooth pair; pair k meets one pitch before pair k-1
    double z, height;              ///< middle and extent along the axis [mm], canonical frame
    double pinion_roll, gear_roll; ///< of the closest points [rad]
    double separation;             ///< least normal distance, unmodified surfaces [mm]
    double lever, gear_lever;      ///< moment of a unit normal force about the pinion's and the gear's axis [mm]
    bool   tip_edge;               ///< closest at a tip edge, outside the path of action
  };

  struct ContactCell
  {
    int    slice;
    Patch  pinion, gear;
    double area;          ///< [mm^2]
    double gap;           ///< mean unloaded normal gap with modifications [mm]
    double lever;         ///< [mm]
    bool   window_border; ///< its outer side is where the grid ends, not the flank
    bool   edge;          ///< cut by a flank's edge, in a tip-edge slice or at a face end: pressure there is reported apart
  };

  /// Kinematics and geometry of one mesh position.
  class MeshPosition
  {
  public:
    /// phase 0: pair 0 touches at the pitch point at mid-face; 1: one pitch on.
    MeshPosition(const GearPair &pair, const FlankModifications &pinion, const FlankModifications &gear, double phase);

    /// All slices whose separation with modifications exceeds the least one by no more than `reach` [mm].
    std::vector<Slice> slices(int per_face_width, double reach) const;

    /// Normal gap of the modified surfaces at a pinion roll angle and z of a tooth pair; the gear's roll angle at its foot. [mm]
    double gap(int pair, double pinion_roll, double z, double &gear_roll) const;

    /// Separation at a slice's closest point with modifications. [mm]
    double modified_separation(const Slice &slice) const;

    /// `across` cells over +-half_width [mm] around a slice's closest point, clipped to both flanks; empty ones are left out.
    void add_cells(const Slice &slice, int slice_index, double half_width, int across, bool face_end,
                   std::vector<ContactCell> &cells) const;

    /// Radius of relative curvature across the contact line. [mm]
    double relative_radius(const Slice &slice) const;

    /// Rotation at which the unloaded surfaces first touch: the geometric transmission error over r_b. [rad]
    double first_touch(int per_face_width) const;

  private:
    double contact_roll(int pair, double z) const; ///< pinion roll angle on the path of action [rad]
    double foot(const Gear &from, const Gear &onto, double from_angle, double onto_angle, double roll, double &onto_roll,
                double &arm) const;

    const GearPair           &pair_;
    const FlankModifications &pinion_modifications_, &gear_modifications_;
    double                    phase_, z_sign_;
    InvoluteHelicoid          pinion_, gear_;
  };
} // namespace flank
