// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_contact.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/half_space/hertz.hpp"
#include "contact/rollers/roller_ends.hpp"
#include "contact/rollers/sagitta.hpp"
#include "contact/solve/certificate.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr int lowest_node = -40;       // 1.3e-4 units; below, the law goes on as a power
    constexpr double unit_strain = 3.5e-7; // a unit of force over E* R L: some newton of a steel roller
    constexpr double node_ratio =
        1.25; // of neighbouring forces; halving it changes the law by less than 1e-5 (a test)

    std::vector<double> borders(const double half, const int cells)
    {
      std::vector<double> result;
      for (int i = 0; i <= cells; ++i)
        result.push_back(half * i / cells);
      return result;
    }

    /// Pressures of a solved quarter; `whole`: its last row of cells lies at the end of the roller.
    PairState state_of(const std::vector<double> &x, const std::vector<double> &y,
                       const ContactSolution &solution, const bool whole, PressureMap *map)
    {
      const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
      PairState state;
      state.force = 4 * solution.torque;
      state.approach = solution.theta;
      state.stiffness = 4 * solution.stiffness;
      for (int p = 0; p < ny; ++p)
        for (int i = 0; i < nx; ++i)
          {
            const double area = (x[i + 1] - x[i]) * (y[p + 1] - y[p]),
                         pressure = solution.force[p * nx + i] / area;
            state.max_pressure = std::max(state.max_pressure, pressure);
            if (p == 0)
              state.mid_pressure = std::max(state.mid_pressure, pressure);
            if (whole && p == ny - 1)
              state.edge_pressure = std::max(state.edge_pressure, pressure);
            if (map)
              {
                map->x.push_back(0.5 * (x[i] + x[i + 1]));
                map->y.push_back(0.5 * (y[p] + y[p + 1]));
                map->half_x.push_back(0.5 * (x[i + 1] - x[i]));
                map->half_y.push_back(0.5 * (y[p + 1] - y[p]));
                map->pressure.push_back(pressure);
              }
          }
      return state;
    }
  } // namespace

  double RollerContactData::crown(const double y) const
  {
    return crown_drop(crown_radius, straight_length, y);
  }

  double RollerContactData::surface_compliance() const
  {
    return half_space::surface_compliance(roller_modulus, roller_poisson) +
           half_space::surface_compliance(sleeve_modulus, sleeve_poisson);
  }

  namespace
  {
    /// What free ends add to the compliance of a quarter's cells and their images.
    void add_free_ends(const RollerEnds &ends, const std::vector<double> &x, const std::vector<double> &y,
                       Eigen::MatrixXd &compliance)
    {
      const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
      const std::vector<Eigen::MatrixXd> added = ends.between({ 2 * nx, 0.5 * (x[1] - x[0]), y });
      for (int p = 0; p < ny; ++p)
        for (int q = 0; q < ny; ++q)
          {
            const Eigen::MatrixXd &of_row = added[static_cast<std::size_t>(p)];
            const Eigen::VectorXd both = of_row.col(ny + q) + of_row.col(ny - 1 - q);
            for (int i = 0; i < nx; ++i)
              for (int j = 0; j < nx; ++j)
                compliance(p * nx + i, q * nx + j) += both[std::abs(i - j)] + both[i + j + 1];
          }
    }
  } // namespace

  ContactProblem quarter_problem(const RollerContactData &data, const std::vector<double> &x,
                                 const std::vector<double> &y, const bool collocation)
  {
    const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1, n = nx * ny;
    const double scale = data.surface_compliance();
    ContactProblem problem{ Eigen::MatrixXd(n, n), Eigen::VectorXd(n), Eigen::VectorXd::Ones(n) };
    const auto middle = [](const std::vector<double> &v, const int i) { return 0.5 * (v[i] + v[i + 1]); };
    const auto half = [](const std::vector<double> &v, const int i) { return 0.5 * (v[i + 1] - v[i]); };
    problem.symmetric = !collocation;
    // Cells across are equal, so the influence depends on their distance alone: a table over it for every
    // pair along.
    std::vector<double> table(2 * nx);
    const double a = half(x, 0), pitch = 2 * a;
    for (int p = 0; p < ny; ++p)
      for (int q = 0; q < ny; ++q)
        {
          const double b = half(y, q), bp = half(y, p);
          for (int d = 0; d < 2 * nx; ++d)
            {
              table[d] = 0;
              for (const double side : { -1.0, 1.0 })
                {
                  const double dy = middle(y, p) - side * middle(y, q);
                  table[d] += scale * (collocation ? half_space::love_potential({ 0, 0, a, b }, d * pitch, dy)
                                                   : half_space::mean_love_potential(
                                                         { 0, 0, a, b }, { d * pitch, dy, a, bp }));
                }
            }
          for (int i = 0; i < nx; ++i)
            for (int j = 0; j < nx; ++j)
              problem.compliance(p * nx + i, q * nx + j) = table[std::abs(i - j)] + table[i + j + 1];
        }
    for (int p = 0; p < ny; ++p)
      for (int i = 0; i < nx; ++i)
        {
          const auto gap = [&](const double at_x, const double at_y) {
            return sagitta(data.roller_radius, at_x) + sagitta(data.sleeve_radius, at_x) + data.crown(at_y);
          };
          double g = gap(middle(x, i), middle(y, p));
          if (!collocation)
            {
              g = 0;
              for (const double u : { -0.5773502691896257, 0.5773502691896257 })
                for (const double v : { -0.5773502691896257, 0.5773502691896257 })
                  g += 0.25 * gap(middle(x, i) + u * half(x, i), middle(y, p) + v * half(y, p));
            }
          problem.gap[p * nx + i] = g;
        }
    if (data.free_ends)
      {
        FLANK_ASSERT(!collocation, "free ends count in the means over cells");
        add_free_ends(*data.free_ends, x, y, problem.compliance);
      }
    if (problem.symmetric)
      problem.compliance =
          (0.5 * (problem.compliance + problem.compliance.transpose())).eval(); // rounding only
    return problem;
  }

  /// The contact problem of the prescribed grid and its law as far as it was asked for: theta(F) of a quarter
  /// from zero to powers of two. An approach is looked up in the first of them that reaches it, so that what
  /// it gets, to the last bit, does not depend on what was asked for before.
  struct PairLaw::Prescribed
  {
    std::vector<double> x, y;
    ContactProblem problem;
    SimplexSolver solver;
    std::map<int, TorqueCurve> curves; ///< by the power of two
    std::mutex mutex;

    const TorqueCurve &curve(const int power)
    {
      TorqueCurve &curve = curves[power];
      if (curve.points.empty())
        curve = solver.curve(0, std::ldexp(1.0, power));
      if (curve.status != Status::solved)
        throw ComputationError(
            fmt::format("the load-approach law of the prescribed grid has no solution up to {:.6g} N",
                        4 * std::ldexp(1.0, power)));
      return curve;
    }

    /// The first that reaches an approach, from a power near it and not far below that.
    const TorqueCurve &reaching(const double approach, const int near)
    {
      int power = near;
      while (curve(power).points.back().theta < approach)
        ++power;
      for (const int least = near - 20; power > least && curve(power - 1).points.back().theta >= approach;)
        --power;
      return curve(power);
    }

    Prescribed(std::vector<double> x_borders, std::vector<double> y_borders, const RollerContactData &data,
               const bool collocation)
        : x(std::move(x_borders))
        , y(std::move(y_borders))
        , problem(quarter_problem(data, x, y, collocation))
        , solver(problem)
    {
    }
  };

  PairLaw::PairLaw(const RollerContactData &data, const RollerGridSize &grid)
      : data_(data)
      , grid_(grid)
  {
    FLANK_ASSERT(grid.across >= 4 && grid.across % 2 == 0 && grid.along >= 2 && grid.along % 2 == 0,
                 "even cells");
    if (grid.half_width > 0)
      prescribed_ = std::make_shared<Prescribed>(borders(grid.half_width, grid.across / 2),
                                                 borders(data.width / 2, grid.along / 2), data, grid.uniform);
  }

  PairState PairLaw::solve(const double force, PressureMap *map) const
  {
    const double effective = 1 / (units::pi * data_.surface_compliance()), radius = data_.relative_radius();
    const int nx = grid_.across / 2, ny = grid_.along / 2;
    const auto line = [&](const double load) {
      return half_space::hertz_half_width(radius, effective, load);
    };
    double half_x = 1.3 * line(force / data_.width), half_y = data_.width / 2;
    for (int attempt = 0; attempt < 24; ++attempt)
      {
        if (half_x > 0.5 * std::min(data_.roller_radius, std::abs(data_.sleeve_radius)))
          throw BeyondHalfSpace(fmt::format("at {:.6g} N a contact would be wider than half a roller: the "
                                            "half-space holds no longer; lower the torque",
                                            force));
        std::vector<double> x(nx + 1), y(ny + 1);
        for (int i = 0; i <= nx; ++i)
          x[i] = half_x * i / nx;
        const bool whole = half_y >= data_.width / 2;
        for (int i = 0; i <= ny; ++i) // over the whole length: cells shrink towards the end as a cosine does
          y[i] = half_y *
                 (grid_.uniform || !whole ? static_cast<double>(i) / ny : std::sin(units::pi / 2 * i / ny));
        const ContactProblem problem = quarter_problem(data_, x, y, grid_.uniform);
        const ContactSolution solution = SimplexSolver(problem).solve(force / 4);
        const Certificate holds = certify(problem, solution);
        if (!holds.holds())
          throw ComputationError(fmt::format(
              "the contact of one roller pair at {:.6g} N failed its certificate: {:.3g}, allowed {:.3g}",
              force, holds.worst(), holds.gate));
        // Extent of the contact: a loaded border widens the grid, an idle half narrows it.
        int reach_x = 0, reach_y = 0;
        for (const int k : solution.active)
          {
            reach_x = std::max(reach_x, k % nx + 1);
            reach_y = std::max(reach_y, k / nx + 1);
          }
        if (reach_x == nx)
          half_x *= 1.3;
        else if (reach_x < 0.6 * nx && attempt < 8) // a few cells cannot tell: then wide is well
          half_x *= 1.25 * reach_x / nx;
        else if (!grid_.uniform && !whole && reach_y == ny)
          half_y = std::min(1.3 * half_y, data_.width / 2);
        else if (!grid_.uniform && y[reach_y] < 0.6 * half_y)
          half_y = 1.2 * y[reach_y];
        else
          {
            PairState state = state_of(x, y, solution, whole, map);
            state.certificate = holds.worst();
            return state;
          }
      }
    throw ComputationError(fmt::format(
        "the grid of one roller pair at {:.6g} N does not settle on the contact's extent", force));
  }

  double PairLaw::node_force(const int index) const
  {
    const double unit =
        unit_strain / (units::pi * data_.surface_compliance()) * data_.roller_radius * data_.width;
    return unit * std::pow(node_ratio, index);
  }

  const PairState &PairLaw::node(const int index) const
  {
    {
      const std::lock_guard lock(mutex_);
      if (const auto it = nodes_.find(index); it != nodes_.end())
        return it->second;
    }
    const PairState state = solve(node_force(index));
    const std::lock_guard lock(mutex_);
    return nodes_.try_emplace(index, state).first->second;
  }

  PairState PairLaw::below(const double force) const
  {
    const PairState &s = node(lowest_node);
    const double part = force / s.force, exponent = s.force / (s.approach * s.stiffness),
                 root = std::sqrt(part); // line contact: pressures go with the root
    return { .force = force,
             .approach = s.approach * std::pow(part, exponent),
             .stiffness = force / (s.approach * std::pow(part, exponent) * exponent),
             .mid_pressure = s.mid_pressure * root,
             .edge_pressure = s.edge_pressure * root,
             .max_pressure = s.max_pressure * root,
             .certificate = s.certificate };
  }

  PairState PairLaw::between(const int index, const double force) const
  {
    const PairState &low = node(index), &high = node(index + 1);
    const double step = std::log(node_ratio), t = std::log(force / low.force) / step;
    const auto slope = [](const PairState &s) { return s.force / (s.approach * s.stiffness); };
    const double y0 = std::log(low.approach), y1 = std::log(high.approach), d0 = step * slope(low),
                 d1 = step * slope(high);
    const double y = y0 + t * (d0 + t * (3 * (y1 - y0) - 2 * d0 - d1 + t * (2 * (y0 - y1) + d0 + d1)));
    const double dy = d0 + t * (2 * (3 * (y1 - y0) - 2 * d0 - d1) + 3 * t * (2 * (y0 - y1) + d0 + d1));
    const double approach = std::exp(y);
    const auto power = [&](const double a, const double b) {
      return a > 0 && b > 0 ? a * std::pow(b / a, t) : a + t * (b - a);
    };
    return { .force = force,
             .approach = approach,
             .stiffness = force / approach * step / dy,
             .mid_pressure = power(low.mid_pressure, high.mid_pressure),
             .edge_pressure = power(low.edge_pressure, high.edge_pressure),
             .max_pressure = power(low.max_pressure, high.max_pressure),
             .certificate = std::max(low.certificate, high.certificate) };
  }

  PairState PairLaw::prescribed(const double approach, const bool pressures) const
  {
    Prescribed &p = *prescribed_;
    const std::lock_guard lock(p.mutex);
    const double near = approach * data_.width / data_.surface_compliance() / 4; // a force of its size
    const auto &points = p.reaching(approach, std::ilogb(near)).points;
    const auto above = std::upper_bound(points.begin() + 1, points.end() - 1, approach,
                                        [](const double t, const Breakpoint &b) { return t < b.theta; });
    const auto below = above - 1;
    const double load = below->torque + (approach - below->theta) * below->stiffness;
    if (!(load > 0))
      return { .approach = approach }; // cells touch at their own gap, not at zero
    if (!pressures)
      return { .force = 4 * load, .approach = approach, .stiffness = 4 * below->stiffness };
    return on_prescribed_cells(load, nullptr);
  }

  PairState PairLaw::on_prescribed_cells(const double load, PressureMap *map) const
  {
    Prescribed &p = *prescribed_;
    const auto solution = p.solver.solve(load);
    const auto holds = certify(p.problem, solution);
    if (!holds.holds())
      throw ComputationError(fmt::format("the contact of one roller pair on the prescribed grid failed its "
                                         "certificate: {:.3g}, allowed {:.3g}",
                                         holds.worst(), holds.gate));
    for (const int k : solution.active)
      if (k % (grid_.across / 2) == grid_.across / 2 - 1)
        throw ComputationError(fmt::format(
            "the prescribed grid of half-width {:.6g} mm ends inside the contact at {:.6g} N; make it wider",
            grid_.half_width, 4 * solution.torque));
    PairState state = state_of(p.x, p.y, solution, true, map);
    state.certificate = holds.worst();
    return state;
  }

  bool PairLaw::is_half_space(const int index) const
  {
    {
      const std::lock_guard lock(mutex_);
      if (index >= first_beyond_)
        return false;
    }
    try
      {
        node(index);
        return true;
      }
    catch (const BeyondHalfSpace &)
      {
        const std::lock_guard lock(mutex_);
        first_beyond_ = std::min(first_beyond_, index);
        return false;
      }
  }

  PairState PairLaw::beyond(const PairState &last, const double approach) const
  {
    PairState state = last;
    for (int i = 0; i < 20 && std::abs(state.approach - approach) > 1e-12 * approach; ++i)
      state = solve(std::max(last.force, state.force + (approach - state.approach) * state.stiffness));
    return state;
  }

  PairState PairLaw::load_at(const double approach) const
  {
    return prescribed_ ? prescribed(approach, false) : at_approach(approach);
  }

  PairState PairLaw::at_approach(const double approach) const
  {
    if (prescribed_)
      return prescribed(approach, true);
    // Force roughly first (stiffness of a line contact), then the interval, then Newton on the cubic.
    if (const PairState &lowest = node(lowest_node); approach <= lowest.approach)
      return below(lowest.force *
                   std::pow(approach / lowest.approach, lowest.stiffness * lowest.approach / lowest.force));
    const double guess = approach * data_.width / data_.surface_compliance() / 20;
    int index = std::max(
        lowest_node, static_cast<int>(std::floor(std::log(guess / node_force(0)) / std::log(node_ratio))));
    while (index > lowest_node && (!is_half_space(index) || node(index).approach > approach))
      --index;
    while (is_half_space(index + 1) && node(index + 1).approach <= approach)
      ++index;
    if (!is_half_space(index + 1))
      return beyond(node(index), approach);
    double low = node(index).force, high = node(index + 1).force, force = std::sqrt(low * high);
    for (int i = 0; i < 60; ++i)
      {
        const PairState s = between(index, force);
        const double error = s.approach - approach;
        (error > 0 ? high : low) = force;
        if (std::abs(error) <= 1e-15 * approach)
          break;
        const double next = force - error * s.stiffness;
        if (next == force)
          break;
        force = next > low && next < high ? next : 0.5 * (low + high);
      }
    return between(index, force);
  }

  PressureMap PairLaw::map(const double force) const
  {
    PressureMap result;
    if (!prescribed_)
      solve(force, &result);
    else
      {
        const std::lock_guard lock(prescribed_->mutex);
        on_prescribed_cells(force / 4, &result);
      }
    return result;
  }
} // namespace flank
