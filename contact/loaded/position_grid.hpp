// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/options.hpp"
#include "contact/loaded/position_compliance.hpp"
#include "contact/solve/contact_problem.hpp"

#include <map>

namespace flank
{
  /// What contact grids are made of: the gear pair, its reduced bodies, numbers of cells, mountings.
  struct MeshBodies
  {
    const GearPair &pair;
    const BodyCompliance &pinion, &gear;
    ContactGridSize grid;
    Mounting pinion_mounting, gear_mounting;
  };

  /// Names every field besides the bodies that places the cells of a position: with equal identities and
  /// equal bodies, slices with equal windows (PositionCompliance::Window) have equal compliance.
  std::string identity_of_cells(const GearPair &pair, const ContactGridSize &grid);

  /// The effective modulus E* of both half-spaces in contact: 1/E* = (1 - nu_p^2)/E_p + (1 - nu_g^2)/E_g.
  /// [MPa]
  double effective_modulus(const GearPair &pair);

  /// All slices of a position, and which of them a grid takes: those within reach of the closest one.
  struct SlicesInReach
  {
    std::vector<Slice> all;
    int undivided; ///< how many slices there were before any was halved
    double height; ///< down to which slices in reach are halved [mm]
    double reach;  ///< how much farther apart than the closest slice one may be to be taken [mm]
  };

  /// Half-width of a slice's window over that of the contact it was made for.
  inline constexpr double window_over_contact = 1.6;

  /// One position's contact problem for torques up to `torque` in one mesh cycle, which tells how far each
  /// tooth pair stands back: slices, the half-width of every slice's window, cells, compliance. It depends on
  /// nothing else: no other cycle, no other position.
  class PositionGrid
  {
  public:
    /// `torque`: the greatest that the grid is for [N mm]; `compliance`: that of the same position and
    /// bodies, kept by reference. Throws ComputationError where no slice has a cell, or where one cell a
    /// slice does not carry the torque.
    PositionGrid(const MeshBodies &bodies, const MeshPosition &position, PositionCompliance &compliance,
                 const SlicesInReach &slices, int cycle, double torque);

    /// Windows of the slices, which follow the contact that is found on them.
    struct Windows
    {
      std::vector<double> centre, half_width; ///< [mm]
      int grids = 1;                          ///< how many grids the search has come to, this one included
      int resolved = 0;                       ///< how many of them gave slices narrower windows of their own

      bool operator==(const Windows &) const = default;
    };

    /// The windows that build() was given; before build() those that the solution with one cell a slice lets
    /// expect.
    const Windows &windows() const { return fit_; }

    /// Cells and compliance for these windows. Throws ComputationError where there are no cells.
    void build(const Windows &windows);

    /// The windows that a solution on this grid asks for, where they do not fit it: windows that end in a
    /// loaded cell are widened; all are narrowed if the most loaded slice inside the flanks does not spread
    /// over about five cells of eleven; where more of the load than GridCertificate allows lies on slices
    /// with too few loaded cells across, these get narrower windows of their own about their load. Nothing
    /// where the windows fit, and where there is no solution or the search has been long enough: the
    /// certificates then say what is wrong.
    std::optional<Windows> refitted(const ContactSolution &solution) const;

    /// The slices that a solution asks for where the grid's are not enough. If a slice that was left out
    /// would touch: those within a greater reach. If fewer slices carry the most loaded tooth pair than a
    /// fifth of those across its line on the path of action: finer ones, those in reach divided, within no
    /// more reach than the load needs; a short contact, of crowned or tilted flanks under a light load, is
    /// then resolved along its length. Where a slice at a face end has the greatest pressure that has a
    /// limit, or more: that slice halved towards the end, until it is short beside the contact's width.
    /// Nothing where the slices are enough. Throws ComputationError where so many slices would be in reach
    /// that no contact needs them.
    std::optional<SlicesInReach> other_slices(const ContactSolution &solution) const;

    /// A first guess at the loaded cells, the surest first: those within the Hertz width of the load that
    /// their slice carries in the solution with one cell a slice.
    std::vector<int> expected_contact() const;

    const ContactProblem &problem() const { return problem_; }

    /// Rotation of the solution with one cell a slice, before any grid is built. [rad]
    double coarse_rotation() const { return coarse_rotation_; }

    const std::vector<Slice> &slices() const { return slices_; }
    const std::vector<ContactCell> &cells() const { return cells_; }
    double asymmetry() const { return asymmetry_; }
    const MeshPosition &position() const { return position_; }

    /// Rotations of the axes on their mountings under forces: the pinion's in the plane of action and across
    /// it, then the gear's. [rad]
    Eigen::Vector4d tilt(const Eigen::VectorXd &force) const;

  private:
    /// Levers of the six springs of the mounting: torsion of pinion and gear, tilts of the pinion, of the
    /// gear. [mm]
    using Levers = Eigen::Matrix<double, 6, 1>;
    static Levers levers(const Slice &slice, const Eigen::Vector4d &tilt);
    Levers flexibility() const; ///< of the springs; zero: rigid [rad/(N mm)]
    Levers moments(const Eigen::VectorXd &force) const;

    /// Slices that are shorter are not halved. [mm]
    double finest_slice() const;

    /// How many loaded slices are enough for the contact of a tooth pair.
    int enough_slices(int pair) const;

    /// Greatest approach beyond first touch that any of some slices sees under a solution. [mm]
    double greatest_overlap(const std::vector<Slice> &slices, const ContactSolution &solution) const;

    /// Greatest approach beyond first touch that a slice left out would see. [mm]
    double overlap_left_out(const ContactSolution &solution) const;
    std::optional<SlicesInReach> finer(const ContactSolution &solution) const;
    std::optional<SlicesInReach> finer_at_ends(const ContactSolution &solution) const;

    /// Down to which slices at face ends are halved, by their numbers: those with the greatest pressure. [mm]
    std::map<int, double> heights_at_ends(const ContactSolution &solution) const;

    SlicesInReach further(const ContactSolution &solution) const;

    /// The three things that refitted() does to windows. False: there is nothing to do.
    bool widen(Windows &windows, const ContactSolution &solution) const;
    bool narrow(Windows &windows, const ContactSolution &solution) const;
    bool resolve(Windows &windows, const ContactSolution &solution) const;

    /// The least half-width with which a window about `centre` [mm] keeps the place where the surfaces of its
    /// slice come closest, however add_cells() rounds it. [mm]
    double least_half_width(std::size_t slice, double centre) const;

    /// A window about the load of a slice that too few cells resolve.
    struct OwnWindow
    {
      std::size_t slice;
      double centre, half_width; ///< [mm]
    };
    std::vector<OwnWindow> unresolved(const ContactSolution &solution) const;

    void add_cells(const Windows &windows, int across);
    void assemble();
    double mean_line_load() const; ///< of all slices [N/mm]

    /// The load of slices that have one cell each. Throws ComputationError where there is none.
    ContactSolution loads_of_slices(double mean_load);
    void size_windows();
    double touch(const Slice &slice) const; ///< least distance of a slice's surfaces in this mesh cycle [mm]
    double in_reach() const;                ///< greatest touch() at which a slice is taken [mm]

    /// All slices, those whose touch() is within `limit` halved down to `height`. [mm]
    SlicesInReach divided(double limit, double reach, double height) const;
    double whole_flank() const;

    const MeshBodies &bodies_;
    const MeshPosition &position_;
    int cycle_;
    SlicesInReach all_;
    double torque_, modulus_, asymmetry_ = 0, coarse_rotation_ = 0;
    PositionCompliance &compliance_;
    std::vector<Slice> slices_, left_out_;
    Windows fit_;
    std::vector<double> hertz_; ///< half-widths of the contact expected [mm]
    std::vector<ContactCell> cells_;

    std::vector<PositionCompliance::Window> windows_; ///< of the slices
    ContactProblem problem_;
  };
} // namespace flank
