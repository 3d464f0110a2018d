// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/roller_pair.hpp"
#include "contact/solve/contact_problem.hpp"

#include <Eigen/Dense>

#include <vector>

namespace flank::roller_pair
{
  /// Cells over a rectangle about the middle of the contact. As the rollers are pressed at mid-length,
  /// everything at (-x, -y) is as at (x, y): the unknowns are the cells of the half y > 0, and each brings
  /// its image.
  struct Grid
  {
    RollerPairGrid count;
    double half_width, half_length; ///< of the rectangle [mm]
    double direction;               ///< of its long side, from the first axis towards the second one [rad]
    Eigen::Matrix2d to_first;       ///< from the grid's x and y to across and along the first roller
    Eigen::Matrix2d to_second;

    Grid(const RollerPairData &data, const RollerPairGrid &cells, const double width, const double length,
         const double angle)
        : count(cells)
        , half_width(width)
        , half_length(length)
        , direction(angle)
        , to_first(Eigen::Rotation2Dd(-angle).toRotationMatrix())
        , to_second(Eigen::Rotation2Dd(data.crossing_angle - angle).toRotationMatrix())
    {
    }

    double half_x() const { return half_width / count.across; }
    double half_y() const { return half_length / count.along; }
    Eigen::Vector2d centre(const int column, const int row) const
    {
      return { (2 * column + 1) * half_x() - half_width, (2 * row + 1) * half_y() };
    }
  };

  /// A cell that both rollers face: its column, and its row from the middle.
  struct Cell
  {
    int column, row;
  };

  /// Whether both rollers face a point of the grid's plane. [mm]
  bool faced(const RollerPairData &data, const Grid &grid, const Eigen::Vector2d &point);

  /// The cells whose middles both rollers face.
  std::vector<Cell> cells_of(const RollerPairData &data, const Grid &grid);

  /// Unknowns: the forces on the cells of one half; lever 1 and half of the force, so that theta is the
  /// approach.
  ContactProblem contact_problem(const RollerPairData &data, const Grid &grid,
                                 const std::vector<Cell> &cells);

  /// What is found on a grid, without the certificate.
  RollerPairContact gather(const RollerPairData &data, const Grid &grid, const std::vector<Cell> &cells,
                           const ContactSolution &solution);
} // namespace flank::roller_pair
