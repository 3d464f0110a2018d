// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_pair.hpp"

#include "contact/rollers/roller_pair_cells.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    using namespace roller_pair;

    /// Where the contact ends on a grid: the outermost loaded column from the middle, the outermost row;
    /// whether they end where the grid ends and the rollers go on.
    struct Reach
    {
      double x = 0, y = 0; ///< to the outer side of the outermost loaded cell [mm]
      bool open_x = false, open_y = false;
    };

    Reach reach_of(const RollerPairData &data, const Grid &grid, const std::vector<Cell> &cells,
                   const ContactSolution &solution)
    {
      Reach reach;
      const auto goes_on = [&](const Eigen::Vector2d &point) { return faced(data, grid, point); };
      for (const int k : solution.active)
        {
          const Cell &cell = cells[static_cast<std::size_t>(k)];
          const Eigen::Vector2d centre = grid.centre(cell.column, cell.row);
          const double side = centre.x() < 0 ? -1 : 1;
          reach.x = std::max(reach.x, std::abs(centre.x()) + grid.half_x());
          reach.y = std::max(reach.y, centre.y() + grid.half_y());
          if (cell.column == 0 || cell.column == grid.count.across - 1)
            reach.open_x = reach.open_x || goes_on(centre + Eigen::Vector2d(2 * side * grid.half_x(), 0));
          if (cell.row == grid.count.along / 2 - 1)
            reach.open_y = reach.open_y || goes_on(centre + Eigen::Vector2d(0, 2 * grid.half_y()));
        }
      return reach;
    }

    /// No point that both rollers face is farther from the middle. [mm]
    double farthest(const RollerPairData &data)
    {
      return std::min(std::hypot(data.first.length / 2, data.first.radius),
                      std::hypot(data.second.length / 2, data.second.radius));
    }

    /// Half-sizes of the grid to begin with: somewhat more than Hertz's ellipse, or than the line over what
    /// both rollers face. [mm]
    std::pair<double, double> first_size(const RollerPairData &data, const double force)
    {
      const RollerPairData::Curvatures curvature = data.curvatures();
      const double modulus = data.effective_modulus(), end = data.longest(curvature.direction);
      if (curvature.least > 1e-12 * curvature.greatest)
        {
          const auto ellipse = half_space::hertz_ellipse(curvature.least, curvature.greatest, modulus, force);
          if (ellipse.long_half_axis < end)
            return { 1.2 * ellipse.short_half_axis, std::min(end, 1.2 * ellipse.long_half_axis) };
        }
      return { 1.2 * half_space::hertz_half_width(1 / curvature.greatest, modulus, force / (2 * end)), end };
    }

    void require_half_space(const RollerPairData &data, const Reach &reach, const double force)
    {
      const double least = std::min(data.first.radius, data.second.radius);
      if (reach.x > 0.5 * least)
        throw ComputationError(fmt::format("at {:.6g} N the contact would be {:.4g} mm wide, more than the "
                                           "radius {:.4g} mm of a roller: the "
                                           "half-space holds no longer; lower load.normal_force_N",
                                           force, 2 * reach.x, least));
    }

    /// The contact must spread over some cells of the grid in both directions.
    void require_resolved(const Grid &grid, const Reach &reach, const double force)
    {
      constexpr double fewest = 8; // of 32 by 48 it takes 22 by 33 as a rule
      const double across = reach.x / grid.half_x(), along = reach.y / grid.half_y();
      if (across < fewest || along < fewest)
        throw ComputationError(fmt::format("at {:.6g} N the contact spreads over {:.0f} by {:.0f} cells, "
                                           "{:.0f} are needed in both directions; "
                                           "give more of them (roller_grid)",
                                           force, across, along, fewest));
    }

    /// Judged by all cells away from the ends.
    void require_linear(const RollerPairData &data, const RollerPairContact &contact, const double force)
    {
      if (contact.inside_pressure > 0.5 * data.effective_modulus())
        throw ComputationError(fmt::format(
            "at {:.6g} N the pressure would be {:.4g} MPa, more than half of the effective modulus "
            "{:.4g} MPa: linear elasticity holds no longer; lower load.normal_force_N",
            force, contact.inside_pressure, data.effective_modulus()));
    }

  } // namespace

  RollerPairContact press(const RollerPairData &data, const RollerPairGrid &size, const double force)
  {
    if (force == 0)
      return {};
    const double direction = data.curvatures().direction;
    const double end = farthest(data);
    auto [half_width, half_length] = first_size(data, force);
    constexpr int most_attempts = 40;
    for (int attempt = 0; attempt < most_attempts; ++attempt)
      {
        const Grid grid(data, size, half_width, half_length, direction);
        const std::vector<Cell> cells = cells_of(data, grid);
        if (cells.empty())
          throw ComputationError(
              fmt::format("at {:.6g} N the contact would be larger than the rollers: the half-space holds no "
                          "longer; lower load.normal_force_N",
                          force));
        const ContactProblem problem = contact_problem(data, grid, cells);
        const ContactSolution solution = SimplexSolver(problem).solve(force / 2);
        const Certificate certificate = certify(problem, solution);
        if (!certificate.holds())
          throw ComputationError(
              fmt::format("the contact at {:.6g} N failed its certificate: {:.3g}, allowed {:.3g}", force,
                          certificate.worst(), certificate.gate));
        const Reach reach = reach_of(data, grid, cells, solution);
        require_half_space(data, reach, force);
        // A loaded border widens the grid, an idle third narrows it, but not again and again: a cell more or
        // less is a step.
        const bool may_narrow = attempt < most_attempts / 2;
        if (reach.open_x || reach.open_y)
          {
            half_width = reach.open_x ? 1.3 * half_width : half_width;
            half_length = reach.open_y ? std::min(end, 1.3 * half_length) : half_length;
          }
        else if (may_narrow && (reach.x < 0.7 * half_width || reach.y < 0.7 * half_length))
          {
            half_width = reach.x < 0.7 * half_width ? 1.15 * reach.x : half_width;
            half_length = reach.y < 0.7 * half_length ? std::min(end, 1.15 * reach.y) : half_length;
          }
        else
          {
            require_resolved(grid, reach, force);
            RollerPairContact result = gather(data, grid, cells, solution);
            require_linear(data, result, force);
            result.certificate = certificate;
            return result;
          }
      }
    throw ComputationError(
        fmt::format("the grid at {:.6g} N does not settle on the contact's extent; another number of cells "
                    "(roller_grid) or another force may be solved",
                    force));
  }

  half_space::SubsurfaceStress below_greatest_pressure(const RollerPairData &data,
                                                       const RollerPairContact &contact)
  {
    if (contact.greatest >= contact.cells.size())
      return {};
    std::vector<half_space::LoadedRectangle> loads;
    const PressedCell &greatest = contact.cells[contact.greatest];
    double widest = 0;
    for (const PressedCell &cell : contact.cells)
      {
        loads.push_back(
            { { cell.x, cell.y, cell.half_x, cell.half_y }, cell.pressure * 4 * cell.half_x * cell.half_y });
        widest = std::max(widest, std::abs(cell.x) + cell.half_x);
      }
    return half_space::greatest_below_both(loads, { { greatest.x, greatest.y } }, 2 * widest,
                                           data.first.poissons_ratio, data.second.poissons_ratio);
  }

} // namespace flank
