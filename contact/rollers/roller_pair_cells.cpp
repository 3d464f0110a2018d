// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_pair_cells.hpp"

#include "contact/rollers/roller_ends.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>

namespace flank::roller_pair
{
  namespace
  {
    bool faces(const CrownedRoller &roller, const Eigen::Vector2d &point)
    {
      return std::abs(point.y()) <= roller.length / 2 && std::abs(point.x()) < roller.radius;
    }

    /// Mean gap over a cell, by 2 x 2 Gauss points. [mm]
    double mean_gap(const RollerPairData &data, const Grid &grid, const Cell &cell)
    {
      constexpr double u = 0.5773502691896257;
      double sum = 0;
      for (const double across : { -u, u })
        for (const double along : { -u, u })
          {
            const Eigen::Vector2d point = grid.centre(cell.column, cell.row) +
                                          Eigen::Vector2d(across * grid.half_x(), along * grid.half_y()),
                                  first = grid.to_first * point, second = grid.to_second * point;
            sum += 0.25 * (data.first.stand_back(first.x(), first.y()) +
                           data.second.stand_back(second.x(), second.y()));
          }
      return sum;
    }

    /// What free ends add to the compliance of the cells and their images.
    void add_free_ends(const RollerEnds &ends, const Grid &grid, const std::vector<Cell> &cells,
                       Eigen::MatrixXd &c)
    {
      const int across = grid.count.across, rows = grid.count.along / 2;
      RollerEnds::Cells all{ across, grid.half_x(), {} };
      for (int row = 0; row <= rows; ++row)
        all.borders.push_back(2 * row * grid.half_y());
      const std::vector<Eigen::MatrixXd> added = ends.between(all);
      for (std::size_t p = 0; p < cells.size(); ++p)
        for (std::size_t q = 0; q < cells.size(); ++q)
          {
            const Cell &a = cells[p], &b = cells[q];
            const Eigen::MatrixXd &of_row = added[static_cast<std::size_t>(a.row)];
            c(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q)) +=
                of_row(std::abs(a.column - b.column), b.row + rows) +
                of_row(std::abs(a.column + b.column + 1 - across), rows - 1 - b.row);
          }
      c = (0.5 * (c + c.transpose())).eval(); // rounding only
    }
  } // namespace

  bool faced(const RollerPairData &data, const Grid &grid, const Eigen::Vector2d &point)
  {
    return faces(data.first, grid.to_first * point) && faces(data.second, grid.to_second * point);
  }

  std::vector<Cell> cells_of(const RollerPairData &data, const Grid &grid)
  {
    std::vector<Cell> cells;
    for (int row = 0; row < grid.count.along / 2; ++row)
      for (int column = 0; column < grid.count.across; ++column)
        if (faced(data, grid, grid.centre(column, row)))
          cells.push_back({ column, row });
    return cells;
  }

  ContactProblem contact_problem(const RollerPairData &data, const Grid &grid, const std::vector<Cell> &cells)
  {
    const auto n = static_cast<Eigen::Index>(cells.size());
    ContactProblem problem{ Eigen::MatrixXd(n, n), Eigen::VectorXd(n), Eigen::VectorXd::Ones(n) };
    // All cells are equal, so that the influence depends on how many columns and rows lie between two of
    // them.
    const double scale = 1 / (units::pi * data.effective_modulus());
    const half_space::Rectangle here{ 0, 0, grid.half_x(), grid.half_y() };
    Eigen::MatrixXd influence(grid.count.across, grid.count.along);
    for (int i = 0; i < grid.count.across; ++i)
      for (int j = 0; j < grid.count.along; ++j)
        influence(i, j) =
            scale * half_space::mean_love_potential(
                        here, { 2 * i * grid.half_x(), 2 * j * grid.half_y(), grid.half_x(), grid.half_y() });
    for (Eigen::Index p = 0; p < n; ++p)
      {
        const Cell &a = cells[static_cast<std::size_t>(p)];
        problem.gap[p] = mean_gap(data, grid, a);
        for (Eigen::Index q = 0; q < n; ++q)
          {
            const Cell &b = cells[static_cast<std::size_t>(q)];
            // The image of b lies in column across - 1 - b.column, in row -1 - b.row.
            problem.compliance(p, q) =
                influence(std::abs(a.column - b.column), std::abs(a.row - b.row)) +
                influence(std::abs(a.column + b.column + 1 - grid.count.across), a.row + b.row + 1);
          }
      }
    if (data.free_ends)
      add_free_ends(*data.free_ends, grid, cells, problem.compliance);
    return problem;
  }
} // namespace flank::roller_pair
