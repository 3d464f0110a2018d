// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_grid.hpp"
#include "contact/solve/simplex_solver.hpp"

namespace flank
{
  /// The line contact under each slice of a grid, beside what its cells of uniform pressure make of it. A
  /// contact inside the flanks and away from kinks of theirs is Hertz's; elsewhere its cells stand for it.
  struct LineContacts
  {
    std::vector<double> excess_approach; ///< of the cells, beyond the contact's; a slice each [mm]
    Eigen::VectorXd excess_by_force;     ///< its derivatives by the forces on the slice's cells; a cell each
                                         ///< [mm/N]
    std::vector<double> certainty;       ///< with which it is Hertz's; 0: its cells stand for it
    Eigen::VectorXd
        pressure; ///< of each cell, scaled so that its slice's greatest is that of the contact [MPa]
  };

  LineContacts line_contacts(const GearPair &pair, const PositionGrid &grid, const ContactSolution &solution);

  /// How far the bodies turn under a solution, without the excess approach of its cells, and what that
  /// depends on; exact while the loaded cells stay the same.
  struct Turned
  {
    double theta;           ///< [rad]
    double stiffness;       ///< dT/dtheta [N mm/rad]; 0 unloaded
    Eigen::VectorXd by_gap; ///< dtheta/dg; a cell each [rad/mm]
  };

  /// `solver`: of the grid's problem.
  Turned turned(const PositionGrid &grid, const ContactSolution &solution, const LineContacts &contacts,
                SimplexSolver &solver);
} // namespace flank
