// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_pair.hpp"

#include "contact/half_space/hertz_stress.hpp"
#include "contact/rollers/roller_ends.hpp"
#include "contact/rollers/sagitta.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
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

    bool faces(const CrownedRoller &roller, const Eigen::Vector2d &point)
    {
      return std::abs(point.y()) <= roller.length / 2 && std::abs(point.x()) < roller.radius;
    }

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

    /// Unknowns: the forces on the cells of one half; lever 1 and half of the force, so that theta is the
    /// approach.
    ContactProblem contact_problem(const RollerPairData &data, const Grid &grid,
                                   const std::vector<Cell> &cells)
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
              scale * half_space::mean_love_potential(here, { 2 * i * grid.half_x(), 2 * j * grid.half_y(),
                                                              grid.half_x(), grid.half_y() });
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

    /// Farthest point of the long direction that both rollers face. [mm]
    double longest(const RollerPairData &data, const double direction)
    {
      double result = 1e300;
      for (const auto &[roller, angle] :
           { std::pair{ &data.first, direction }, { &data.second, direction - data.crossing_angle } })
        {
          const double along = std::abs(std::cos(angle)), across = std::abs(std::sin(angle));
          result = std::min({ result, along > 0 ? roller->length / 2 / along : result,
                              across > 0 ? roller->radius / across : result });
        }
      return result;
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
      const double modulus = data.effective_modulus(), end = longest(data, curvature.direction);
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
      result.max_pressure =
          result.greatest < result.cells.size() ? result.cells[result.greatest].pressure : 0;
      return result;
    }
  } // namespace

  double CrownedRoller::stand_back(const double across, const double along) const
  {
    return sagitta(radius, across) + crown_drop(crown_radius, straight_length, along);
  }

  double RollerPairData::effective_modulus() const
  {
    return half_space::effective_modulus(first.youngs_modulus, first.poissons_ratio, second.youngs_modulus,
                                         second.poissons_ratio);
  }

  RollerPairData::Curvatures RollerPairData::curvatures() const
  {
    // Each roller: 1/R across its axis and that of its crown along it, turned into the first roller's frame.
    const auto of = [](const CrownedRoller &roller, const double angle) {
      const double along =
          roller.crown_radius > 0 && roller.straight_length == 0 ? 1 / roller.crown_radius : 0;
      const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
      return Eigen::Matrix2d(turn * Eigen::Vector2d(1 / roller.radius, along).asDiagonal() *
                             turn.transpose());
    };
    const Eigen::Matrix2d sum = of(first, 0) + of(second, -crossing_angle);
    const double mean = 0.5 * sum.trace(), difference = 0.5 * (sum(0, 0) - sum(1, 1)), twist = sum(0, 1);
    const double radius = std::hypot(difference, twist);
    // Of the greatest curvature, from the x axis (across the first roller); the least one is at right angles
    // to it.
    const double angle = radius > 1e-14 * mean ? 0.5 * std::atan2(twist, difference) : 0;
    return { std::max(0.0, mean - radius), mean + radius, 0.0 - angle };
  }

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

  HertzReference hertz(const RollerPairData &data, const double force)
  {
    if (force == 0)
      return {};
    const auto straight = [](const CrownedRoller &roller) { return roller.crown_radius == 0; };
    const auto round = [](const CrownedRoller &roller) {
      return roller.crown_radius > 0 && roller.straight_length > 0;
    };
    const RollerPairData::Curvatures curvature = data.curvatures();
    HertzReference result;
    const bool parallel = std::abs(std::sin(data.crossing_angle)) < 1e-12; // 180 degrees too
    if (parallel && straight(data.first) && straight(data.second))
      result.line = half_space::hertz_line(1 / curvature.greatest, data.effective_modulus(),
                                           force / std::min(data.first.length, data.second.length));
    else if (round(data.first) || round(data.second))
      result.missing = "a crown has a straight part";
    else if (curvature.least <= 0)
      result.missing = "the rollers do not curve away from each other in all directions";
    else
      {
        const auto ellipse =
            half_space::hertz_ellipse(curvature.least, curvature.greatest, data.effective_modulus(), force);
        if (ellipse.long_half_axis < longest(data, curvature.direction))
          result.ellipse = ellipse;
        else
          result.missing = "the rollers' ends cut Hertz's ellipse";
      }
    const auto below = [&](const auto &contact) {
      result.subsurface =
          half_space::greatest_below(contact, data.first.poissons_ratio, data.second.poissons_ratio);
    };
    if (result.line)
      below(*result.line);
    if (result.ellipse)
      below(*result.ellipse);
    return result;
  }
} // namespace flank
