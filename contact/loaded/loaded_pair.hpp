// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/half_space/subsurface.hpp"
#include "contact/loaded/position_grid.hpp"
#include "contact/solve/certificate.hpp"

#include <memory>

namespace flank
{
  struct PairLoad
  {
    int pair;
    double force;        ///< normal force [N]
    double max_pressure; ///< [MPa]
  };

  /// Load on one slice of one tooth pair: a point of the contact line.
  struct LineLoad
  {
    int pair;
    double z, pinion_roll;  ///< user's z [mm], [rad]
    double load_per_length; ///< along the contact line [N/mm]
    double max_pressure;    ///< [MPa]
    double half_width;      ///< of the loaded cells, along the profile [mm]
  };

  /// A cell of a contact grid, which the torques of a band share.
  struct GridCell
  {
    int pair;
    double z, pinion_roll, gear_roll; ///< user's z [mm], [rad]
    double area, gap;                 ///< [mm^2], [mm]
    CellPlace place;
  };
  using GridCells = std::shared_ptr<const std::vector<GridCell>>;
  using ContactCells = std::shared_ptr<const std::vector<ContactCell>>;

  /// One mesh position at one torque.
  struct PositionResult
  {
    double torque = 0, phase = 0;
    double theta = 0;                                 ///< pinion rotation ahead of the gear [rad]
    double stiffness = 0;                             ///< tangent dT/dtheta [N mm/rad]; 0 unloaded
    double gear_torque = 0;                           ///< [N mm]
    double max_pressure = 0, edge_pressure = 0;       ///< inside, and at edges [MPa]
    double max_pressure_roll = 0, max_pressure_z = 0; ///< pinion's roll angle [rad], user's z [mm]
    double shuttling_moment =
        0; ///< of the force in the plane of action about z = 0; over that force: its centre [N mm]
    double load_centre = 0;                         ///< z of the resultant [mm]
    double max_line_load = 0;                       ///< per length of contact line [N/mm]
    Eigen::Vector4d tilt = Eigen::Vector4d::Zero(); ///< of the mountings: pinion in, across the plane of
                                                    ///< action; gear; user's z [rad]
    Certificate certificate;
    double asymmetry = 0; ///< of the compliance before symmetrising, relative
    int cells = 0, pivots = 0, grids = 0;
    half_space::SubsurfaceStress
        subsurface; ///< below the slice of max_pressure, where LoadedPair::subsurface_stress asks for it
    std::vector<double>
        theta_by_parameter; ///< derivatives by the deviations' parameters, where LoadedPair::derivatives asks
                            ///< for them [rad over their units]; not journalled by runs
    std::vector<PairLoad> pairs;
    std::vector<LineLoad> lines;

    /// Where LoadedPair::keep_cells asks for it, of the first mesh cycle.
    ContactCells contact_cells;
    Eigen::VectorXd contact_force, contact_gap; ///< on them, and what is left between the surfaces [N, mm]

    GridCells grid_cells; ///< of the first mesh cycle; null where nothing is loaded and in later cycles
    std::vector<double> cell_forces; ///< on them [N]
  };

  /// A mesh position and all its slices, which its torques share. Of the mesh that made it, whose pair and
  /// deviations it refers to.
  struct SlicedPosition
  {
    MeshPosition position;
    std::vector<Slice> slices;
  };

  struct LoadedPair
  {
    MeshBodies bodies;
    MeshDeviations deviations;
    bool derivatives = false; ///< exact ones of the rotation, by all parameters of the modifications
    bool keep_cells = false;  ///< of the contact, in the results
    bool subsurface_stress = false;

    /// The position of a phase (as MeshPosition's).
    SlicedPosition at(double phase) const;

    /// Torques of one band (each > 0) at one position of this mesh, in mesh cycles (in which other teeth
    /// meet). Result [cycle][torque]. A cycle's grid is sized for its greatest torque, and all torques share
    /// it for which it is fine enough; it depends on nothing in other cycles. Cycles in which every pair
    /// stands back as in an earlier one are not solved again. Throws ComputationError if a solution or the
    /// grid under it fails its certificate. compliance: of this position, bodies and geometry, where others
    /// use it too.
    std::vector<std::vector<PositionResult>> solve(const SlicedPosition &sliced,
                                                   const std::vector<double> &torques,
                                                   const std::vector<int> &cycles,
                                                   PositionCompliance &compliance) const;

    /// The same where nothing is shared.
    std::vector<std::vector<PositionResult>> solve(double phase, const std::vector<double> &torques,
                                                   const std::vector<int> &cycles) const;

    /// Any torques (>= 0): each band on a grid of its own, unloaded the geometric transmission error. With
    /// other deviations of the bodies' pair (MeshDeviations::with) this is what they do to the transmission
    /// error, with derivatives by all of their parameters; the compliance serves them all.
    /// Result [cycle][torque].
    std::vector<std::vector<PositionResult>> solve_all(const SlicedPosition &sliced,
                                                       const std::vector<double> &torques,
                                                       const std::vector<int> &cycles,
                                                       PositionCompliance &compliance) const;

    /// The first mesh cycle alone.
    std::vector<PositionResult> solve(double phase, const std::vector<double> &torques) const;

    /// Unloaded: the geometric transmission error of the true surfaces.
    PositionResult unloaded(double phase, int cycle = 0) const;

    std::size_t n_parameters() const { return derivatives ? deviations.n_parameters() : 0; }

  private:
    std::vector<PositionResult> solve_cycle(const SlicedPosition &sliced, const std::vector<double> &torques,
                                            int cycle, PositionCompliance &compliance) const;
    std::vector<PositionResult> gather_all(const SlicedPosition &sliced, int cycle, const PositionGrid &grid,
                                           const std::vector<ContactSolution> &solutions,
                                           const std::vector<Certificate> &certificates, int grids) const;
  };

  /// Torques grouped so that one grid serves each group: indices into `torques`, greatest first; zero torques
  /// left out.
  std::vector<std::vector<int>> torque_bands(const std::vector<double> &torques, int profile_cells);
} // namespace flank
