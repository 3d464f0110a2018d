// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_ends.hpp"
#include "contact/rollers/roller_pair_cells.hpp"

#include <algorithm>
#include <cmath>

namespace flank::roller_pair
{
  namespace
  {
    /// Whether a roller ends beside a cell, along the grid or across it.
    struct EndsBeside
    {
      bool along = false, across = false;
    };

    /// How far from the middle a pressure counts that rises towards an end: as far as it falls from the end
    /// inwards. `greatest`: of the cells at each distance from the middle, in cells. The few cells beside an
    /// end are left out: the peak there makes them uneven.
    int before_the_rise(const std::vector<double> &greatest)
    {
      constexpr int uneven = 4;
      int k = std::max(0, static_cast<int>(greatest.size()) - 1 - uneven);
      while (k > 0 && greatest[k - 1] < greatest[k])
        --k;
      return k;
    }

    /// The cell that has the greatest pressure of those away from the ends. Where the contact reaches ends,
    /// the pressure may rise towards them for a good way, and grows there as cells shrink: of those before
    /// that rise, which are those in the middle of straight rollers. Cells come in pairs, of which the first
    /// is looked at; without a cell away from the ends their number.
    std::size_t greatest_inside(const Grid &grid, const std::vector<PressedCell> &cells,
                                const std::vector<EndsBeside> &ends)
    {
      const auto distance = [](const double centre, const double half) {
        return static_cast<std::size_t>(std::abs(centre) / (2 * half));
      };
      EndsBeside any;
      std::vector<double> along(static_cast<std::size_t>(grid.count.along / 2), 0.0),
          across(static_cast<std::size_t>(grid.count.across / 2), 0.0);
      for (std::size_t i = 0; i < ends.size(); ++i)
        {
          const PressedCell &cell = cells[2 * i];
          double &of_row = along[distance(cell.y, cell.half_y)],
                 &of_column = across[distance(cell.x, cell.half_x)];
          of_row = std::max(of_row, cell.pressure);
          of_column = std::max(of_column, cell.pressure);
          any = { any.along || ends[i].along, any.across || ends[i].across };
        }
      const std::size_t rows = any.along ? before_the_rise(along) : along.size(),
                        columns = any.across ? before_the_rise(across) : across.size();
      std::size_t result = cells.size();
      for (std::size_t i = 0; i < ends.size(); ++i)
        if (const PressedCell &cell = cells[2 * i];
            !ends[i].along && !ends[i].across && distance(cell.y, cell.half_y) <= rows &&
            distance(cell.x, cell.half_x) <= columns &&
            (result == cells.size() || cell.pressure > cells[result].pressure))
          result = 2 * i;
      return result;
    }
  } // namespace

  RollerPairContact gather(const RollerPairData &data, const Grid &grid, const std::vector<Cell> &cells,
                           const ContactSolution &solution)
  {
    RollerPairContact result;
    result.approach = solution.theta;
    result.stiffness = 2 * solution.stiffness;
    const double area = 4 * grid.half_x() * grid.half_y();
    std::vector<EndsBeside> ends;
    for (const int k : solution.active)
      {
        const Cell &cell = cells[static_cast<std::size_t>(k)];
        const Eigen::Vector2d centre = grid.centre(cell.column, cell.row);
        const double pressure = solution.force[k] / area;
        const auto free = [&](const double columns, const double rows) {
          return !faced(data, grid,
                        centre + Eigen::Vector2d(2 * columns * grid.half_x(), 2 * rows * grid.half_y()));
        };
        ends.push_back({ .along = free(0, 1) || free(0, -1), .across = free(1, 0) || free(-1, 0) });
        double &peak =
            ends.back().along || ends.back().across ? result.edge_pressure : result.inside_pressure;
        peak = std::max(peak, pressure);
        result.width = std::max(result.width, 2 * (std::abs(centre.x()) + grid.half_x()));
        result.length = std::max(result.length, 2 * (centre.y() + grid.half_y()));
        for (const double sign : { 1.0, -1.0 })
          result.cells.push_back(
              { sign * centre.x(), sign * centre.y(), grid.half_x(), grid.half_y(), pressure });
      }
    if (const double power = data.free_ends ? data.free_ends->pressure_exponent() : 0; power < 0)
      result.end_intensity = // the mean over a cell at the end
          result.edge_pressure * (1 + power) * std::pow(2 * grid.half_y(), -power);
    result.greatest = greatest_inside(grid, result.cells, ends);
    result.max_pressure = result.greatest < result.cells.size() ? result.cells[result.greatest].pressure : 0;
    return result;
  }
} // namespace flank::roller_pair
