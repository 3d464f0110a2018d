// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/position_compliance.hpp"
#include "contact/solve/contact_problem.hpp"

#include <limits>

namespace flank
{
  struct ContactGridSize
  {
    int slices        = 41; ///< across the face, 2N+1 of P1
    int profile_cells = 11; ///< across the profile, 2M+1 of P1
  };

  /// Linear springs between a gear's hub and its ground; infinite: rigid. [N mm/rad]
  struct Mounting
  {
    static constexpr double rigid = std::numeric_limits<double>::infinity();
    double torsion = rigid, tilt_in_plane = rigid, tilt_across = rigid; ///< about its axis; in and across the plane of action, at mid-face
  };

  /// What the grid of one mesh position stands on.
  struct MeshBodies
  {
    const GearPair       &pair;
    const BodyCompliance &pinion, &gear;
    ContactGridSize       grid;
    Mounting              pinion_mounting, gear_mounting;
  };

  /// One position's contact problem for torques up to `torque` and any of several mesh cycles, which differ in how far each tooth
  /// pair stands back: slices, the half-width of every slice's window, cells, compliance.
  class PositionGrid
  {
  public:
    /// `candidates`: all slices of the position. A slice is taken if in some cycle it is within `reach` of the closest one. [N mm, mm]
    /// `compliance`: of the same position and bodies, kept by reference.
    PositionGrid(const MeshBodies &bodies, const MeshPosition &position, PositionCompliance &compliance,
                 const std::vector<Slice> &candidates, const std::vector<int> &cycles, double torque, double reach);

    /// Cells and compliance for the present windows.
    void build();

    /// Cells within the Hertz width of the load that one cell a slice found, the surest first: where to look for the contact first.
    std::vector<int> expected_contact() const;

    /// Widens the windows that end in a loaded cell under this solution; false if there is none.
    bool widen(const ContactSolution &greatest);

    /// The most loaded slice inside the flanks must spread over about five cells of eleven in every solution: narrows all
    /// windows if it does in none.
    bool narrow(const std::vector<ContactSolution> &greatest);

    /// The contact problem of one cycle; the reference is to an object that the next call changes.
    const ContactProblem &problem(int cycle);

    /// Greatest approach beyond first touch that a slice left out would see. [mm]
    double overlap_left_out(int cycle, const ContactSolution &solution) const;

    /// Greatest rotation that one cell a slice found, before any grid is built. [rad]
    double coarse_rotation() const { return coarse_rotation_; }

    const std::vector<Slice>       &slices() const { return slices_; }
    const std::vector<ContactCell> &cells() const { return cells_; }
    double                          asymmetry() const { return asymmetry_; }

    /// Rotations of the two axes under forces: pinion in, across the plane of action; gear. [rad]
    Eigen::Vector4d tilt(const Eigen::VectorXd &force) const;

  private:
    /// Levers of the six springs of the mounting: torsion of pinion and gear, tilts of the pinion, of the gear. [mm]
    using Levers = Eigen::Matrix<double, 6, 1>;
    static Levers levers(const Slice &slice, const Eigen::Vector4d &tilt);
    Levers        flexibility() const; ///< of the springs; zero: rigid [rad/(N mm)]
    Levers        moments(const Eigen::VectorXd &force) const;

    void add_cells(const std::vector<double> &half_width, int across);
    void assemble();
    void size_windows(const std::vector<int> &cycles);

    const MeshBodies        &bodies_;
    const MeshPosition      &position_;
    double                   torque_, modulus_ = 0, asymmetry_ = 0, coarse_rotation_ = 0;
    PositionCompliance      &compliance_;
    std::vector<Slice>       slices_, left_out_;
    std::vector<int>         number_; ///< of a slice among all of the position
    std::vector<double>      half_width_, hertz_;
    std::vector<ContactCell> cells_;

    std::vector<PositionCompliance::Window> windows_;    ///< of the slices
    Eigen::VectorXd                         common_gap_; ///< without what single teeth stand back
    ContactProblem                          problem_;
  };
} // namespace flank
