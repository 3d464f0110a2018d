// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/line_contacts.hpp"
#include "contact/solve/certificate.hpp"

#include <memory>
#include <string>

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
    double z, pinion_roll;    ///< user's z [mm], [rad]
    double load_per_length;   ///< along the contact line [N/mm]
    double max_pressure;      ///< [MPa]
    double half_width;        ///< of the loaded cells, along the profile [mm]
    double height;            ///< of the slice: extent along the axis [mm]
    double edge_pressure = 0; ///< of the cells at sharp edges; 0: none carries [MPa]
    double certainty = 0;     ///< with which the pressure is that of Hertz's line contact, else of cells [-]
    double tip_edge_load = 0; ///< per length of the tip edge, on slices that touch there alone [N/mm]
    double tip_intensity = 0, tip_power = 0; ///< of the pressure at a sharp tip edge that bounds the slice
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

  /// What LoadedPair::measures found of a solution.
  struct Measured
  {
    std::string name; ///< of the measure
    std::vector<double> values;
  };

  /// One mesh position at one torque.
  struct PositionResult
  {
    double torque = 0, phase = 0;
    std::string failure;    ///< why there is no solution; empty: there is one, which all else describes
    double theta = 0;       ///< pinion rotation ahead of the gear [rad]
    double stiffness = 0;   ///< tangent dT/dtheta [N mm/rad]; 0 unloaded
    double gear_torque = 0; ///< [N mm]
    double max_pressure = 0, edge_pressure = 0;       ///< where it has a limit; at sharp edges [MPa]
    double max_pressure_roll = 0, max_pressure_z = 0; ///< pinion's roll angle [rad], user's z [mm]
    double shuttling_moment = 0; ///< moment of the cells' transverse forces about z = 0 [N mm]
    double load_centre = 0; ///< shuttling_moment over the sum of these forces: user's z of the resultant [mm]
    double max_line_load = 0; ///< greatest load per length of contact line [N/mm]
    double tip_edge_load = 0; ///< greatest load per length of tip edge, 5 % of the face from its ends [N/mm]

    /// At the sharp face end that carries the greatest pressure of such ends, away from tip edges: what the
    /// pressure comes to near it, times the distance to the power -end_power [MPa, mm]; the power, of
    /// end_powers(). 0: none carries.
    double end_intensity = 0, end_power = 0;

    /// The same at the sharp tip edge where it is greatest, 5 % of the face from its ends.
    double tip_intensity = 0, tip_power = 0;

    /// Rotations of the axes on their mountings, signs by the user's z: the pinion's in the plane of action
    /// and across it, then the gear's. [rad]
    Eigen::Vector4d tilt = Eigen::Vector4d::Zero();

    Certificate certificate;
    double asymmetry = 0; ///< of the compliance before symmetrising, relative
    double condition =
        0; ///< of the loaded cells' compliance, where LoadedPair::conditioning asks for it, else 0
    int cells = 0, pivots = 0, grids = 0;
    std::vector<Measured> measured;
    std::vector<double>
        theta_by_parameter; ///< derivatives by the deviations' parameters, where LoadedPair::derivatives asks
                            ///< for them [rad over their units]; not journalled by runs
    std::vector<PairLoad> pairs;
    std::vector<LineLoad> lines;

    /// The cells of the contact, as both bodies see them, with the force on each [N] and the gap that is left
    /// there under load [mm]. Kept in the first mesh cycle where LoadedPair::keep_cells asks for them.
    ContactCells contact_cells;
    Eigen::VectorXd contact_force, contact_gap;

    /// The cells of the grid as results.h5 shows them, with the force on each [N]. Null where nothing is
    /// loaded, and in all mesh cycles but the first.
    GridCells grid_cells;
    std::vector<double> cell_forces;
  };

  /// Transmission error along the transverse line of action, positive where the driven gear lags. [mm]
  double transmission_error(const GearPair &pair, const PositionResult &result);

  /// Tangent mesh stiffness d(T/r_b)/d eps along the transverse line of action; 0 unloaded. [N/mm]
  double tangent_stiffness(const GearPair &pair, const PositionResult &result);

  /// Secant mesh stiffness (T/r_b)/eps; 0 where there is no transmission error. [N/mm]
  double secant_stiffness(const GearPair &pair, const PositionResult &result);

  /// Secant mesh stiffness (T/r_b)/eps of a torque [N mm] with any transmission error, such as the mean of a
  /// mesh cycle; 0 where that is 0. [N over the error's unit of length]
  double secant_stiffness(const GearPair &pair, double torque, double transmission_error);

  /// What a measure found. Empty where it was not asked for: LoadedPair::measures has none of that name, or
  /// nothing is loaded.
  std::vector<double> measured(const PositionResult &result, const std::string &name);

  /// Share of the normal force that one tooth pair of a position carries.
  double load_share(const PositionResult &result, const PairLoad &load);

  /// The cells of a grid, for results; torques on the same grid share them.
  GridCells grid_cells_of(const GearPair &pair, const PositionGrid &grid);

  /// What a solution on a grid says, without what PositionResult keeps on request. `phase`: counted on
  /// through the mesh cycles; `contacts`: the line contacts under its cells; `grid_cells`: of this
  /// grid.
  PositionResult position_result(const GearPair &pair, double phase, const PositionGrid &grid,
                                 const ContactSolution &solution, const LineContacts &contacts,
                                 const Turned &turned, const Certificate &certificate,
                                 const GridCells &grid_cells);
} // namespace flank
