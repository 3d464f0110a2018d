// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/deviations.hpp"
#include "contact/flanks/face_ends.hpp"
#include "contact/flanks/patch.hpp"

#include <array>
#include <optional>

namespace flank
{
  /// The pair in the canonical frame: pinion right-hand and driving counter-clockwise; z = z_sign * the
  /// user's z. Every other hand and direction of drive is a mirror image with the same transmission error.
  double canonical_z_sign(const PairData &data);

  /// Roll angle where contact on a flank can end: at the end of the involute, or on its rounding (before the
  /// arc turns to the tip circle). [rad]
  double end_roll(const Gear &gear);

  /// Where two surfaces face each other at one z, along the common normal.
  struct FacingPoints
  {
    double pinion_roll, gear_roll; ///< [rad]
    double z;                      ///< canonical frame [mm]
    double separation; ///< normal distance of the unmodified surfaces, roundings of tips included [mm]
  };

  /// A strip of the face width of one tooth pair at one mesh position, placed by closest approach of the
  /// unmodified surfaces and their tip edges: every flank variant has the same.
  struct Slice
  {
    int number;                    ///< unlike that of any other slice of the position, halves included
    int pair;                      ///< tooth pair; pair k meets one pitch before pair k-1
    double z, height;              ///< middle and extent along the axis [mm], canonical frame
    double pinion_roll, gear_roll; ///< of the closest points [rad]
    double normal_angle; ///< of the pinion's outward normal in the transverse plane, from +y towards -x [rad]
    double lever, gear_lever; ///< moment of a unit normal force about the pinion's and the gear's axis [mm]
    bool tip_edge;            ///< closest at a tip edge, outside the path of action
    bool rounded;             ///< and that edge is a rounding along which slices run: a spur gear's
    bool face_end;            ///< touches an end of the common face width
    double end_power;         ///< of end_powers() beside it; 0: none, or the pressure has a limit
    double touch;        ///< least normal distance of the surfaces with their deviations, anywhere near [mm]
    double touch_offset; ///< from the closest point to there, along the pinion's profile [mm]

    /// Moments of a unit normal force about the axes that the gears can tilt about: the pinion's in the plane
    /// of action and across it, then the gear's. [mm]
    Eigen::Vector4d tilt;
  };

  enum class CellPlace
  {
    inside,
    tip_edge,    ///< cut by a flank's edge, beside a spur gear's, or in a slice outside the path of action
    face_end,    ///< beside one where pressure is singular
    corner,      ///< of tip edge and face end
    finite_end,  ///< at a face end where pressure has a limit
    rounded_tip, ///< of a spur gear, in a slice outside the path of action
  };

  /// Whether pressure has no limit at a place, and stands apart.
  constexpr bool is_sharp(const CellPlace place)
  {
    return place == CellPlace::tip_edge || place == CellPlace::face_end || place == CellPlace::corner;
  }

  struct ContactCell
  {
    int slice;
    Patch pinion, gear;
    double area;          ///< [mm^2]
    double gap;           ///< mean unloaded normal gap of the surfaces with their deviations [mm]
    double lever;         ///< [mm]
    bool window_border;   ///< its outer side is where the grid ends, not the flank
    bool cut_short;       ///< a tip edge ends a contact that loads it, however fine the cells are
    CellPlace place;      ///< where it is sharp, pressure is reported apart
    Eigen::Vector4d tilt; ///< as the slice's, at the cell's centre [mm]
  };

  /// Kinematics and geometry of one mesh position.
  class MeshPosition
  {
  public:
    /// phase 0: pair 0 touches at the pitch point at mid-face; 1: one pitch on.
    MeshPosition(const GearPair &pair, const MeshDeviations &deviations, double phase,
                 EndsOfFlanks ends = EndsOfFlanks::free);

    double phase() const { return phase_; }

    /// Powers of the pressure at the pinion's and the gear's tip edge, as tip_powers() tells.
    const std::array<double, 2> &tip_powers() const { return tip_powers_; }

    /// All slices within one pitch of the path of action.
    std::vector<Slice> slices(int per_face_width) const;

    /// slices(), halved and halved again where a tooth pair enters or leaves the mesh at a corner of the
    /// flanks, on a line shorter than a fifth and a tenth of what it can be: there, and as far beyond as the
    /// load can make them touch. It follows from the unmodified flanks alone, as every slice does. The second
    /// of the pair: how many slices() there are.
    std::pair<std::vector<Slice>, int> slices_finer_at_corners(int per_face_width) const;

    /// The two halves of a slice across the face, one or none where slice_at() has none. `undivided`: how
    /// many slices() there are, behind whose numbers those of halves follow.
    std::vector<Slice> halves(const Slice &slice, int undivided) const;

    /// The slice of a tooth pair at z [mm], without height and number; none more than a pitch from the path
    /// of action, where one of the gears has no involute, or where no points of the flanks face each other.
    std::optional<Slice> slice_at(int pair, double z) const;

    /// Facing points of a tooth pair for a pinion roll angle at z.
    FacingPoints facing(int pair, double pinion_roll, double z) const;

    /// Normal gap at facing points of a slice with all deviations that are common to the teeth. [mm]
    double gap(const Slice &slice, const FacingPoints &points) const;

    /// Derivative of a cell's mean gap by a parameter of the modifications, by its number. [mm over the
    /// parameter's unit]
    double gap_derivative(const Slice &slice, const ContactCell &cell, std::size_t parameter) const;

    /// How far a pair's flanks stand back as a whole. [mm]
    StandBack stand_back(const int pair, const int cycle) const
    {
      return deviations_.stand_back(pair_, pair, cycle, phase_);
    }

    /// How much that opens the gap on a slice, normal to the flanks: a rotation of each, by its lever there,
    /// which outside the path of action is another one. [mm]
    double stand_back(const Slice &slice, int cycle) const;

    /// `across` cells over centre +- half_width [mm], counted along the pinion's profile from a slice's
    /// closest point, clipped to both flanks; empty ones are left out. Where one spur gear's sharp tip edge
    /// lies in that range, they end there and narrow towards it.
    void add_cells(const Slice &slice, int slice_index, double centre, double half_width, int across,
                   std::vector<ContactCell> &cells) const;

    /// Radius of relative curvature across the contact line. [mm]
    double relative_radius(const Slice &slice) const;

    /// Distance along the profile from a slice's closest point to the nearer tip edge. [mm]
    double distance_to_edge(const Slice &slice) const;

    /// Rotation at which the unloaded surfaces first touch: the geometric transmission error over r_b. Sought
    /// in slices first, then between the neighbours of the one that touches first, ends of the face too.
    /// [rad]
    double first_touch(int per_face_width, int cycle = 0) const
    {
      return first_touching(per_face_width, cycle).second;
    }

    /// Derivative of first_touch() by a parameter of the modifications, by its number. [rad over the
    /// parameter's unit]
    double first_touch_derivative(int per_face_width, int cycle, std::size_t parameter) const;

  private:
    double contact_roll(int pair, double z) const; ///< pinion roll angle on the path of action [rad]
    double mate_roll(double contact_roll) const; ///< of the gear, where the pinion's is `contact_roll` [rad]

    /// Where along the axis a helical pair's line of contact of the unmodified flanks begins and ends, on
    /// faces as wide as that takes. [mm]
    std::pair<double, double> contact_line(int pair) const;

    /// The other involute's normal through a point of one.
    struct Foot
    {
      double distance;     ///< transverse, from the point [mm]
      double roll;         ///< of the other involute there [rad]
      double normal_angle; ///< in the transverse plane [rad]
      double arm;          ///< about the first gear's axis [mm]
    };
    Foot foot(const Gear &from, const Gear &onto, double from_angle, double onto_angle, double roll) const;
    bool on_flanks(const FacingPoints &points) const;
    void mark_end(Slice &slice) const;
    void place_on_rounding(Slice &slice) const;
    Eigen::Vector4d tilt_levers(const Slice &slice, double pinion_roll, double z) const;
    void find_touch(Slice &slice) const;

    /// Facing points at x along the profile and y along the generator from a slice's closest point. [mm]
    FacingPoints facing_at(const Slice &slice, double x, double y) const;
    std::array<FacingPoints, 4> gauss_points(const Slice &slice, const Eigen::Vector2d &centre,
                                             const Eigen::Vector2d &half) const;
    /// Where the cells of a slice begin and end along the profile, and what of it, as wide as equal cells
    /// would be, is beside a sharp tip edge towards which they narrow. [mm]
    struct Borders
    {
      std::vector<double> at;
      std::array<double, 2> edge = { 0, 0 };
    };
    Borders borders_of_cells(const Slice &slice, double middle, double half_width, int across) const;
    double removed_derivative(const FacingPoints &points, std::size_t parameter) const;
    std::pair<Slice, double> first_touching(int per_face_width, int cycle) const;

    const GearPair &pair_;
    const MeshDeviations &deviations_;
    double tan_pressure_angle_;                             ///< working, transverse
    double phase_, z_sign_, face_low_, face_high_, gear_z_; ///< z's in the canonical frame
    std::array<double, 2> end_powers_, tip_powers_;
    InvoluteHelicoid pinion_, gear_;
  };
} // namespace flank
