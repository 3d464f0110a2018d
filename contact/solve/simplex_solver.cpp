// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/simplex_solver.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr int block_pivoting_cap = 30; // good starts take 2 to 8

    // A singular block (duplicated cells, near-singular kernels) gets a little more on its diagonal: cells
    // that cannot be told apart then share their load, and what it changes is far below the certificate's
    // gate.
    constexpr double regularisations[] = { 0.0, 0x1p-44, 0x1p-38, 0x1p-32 };
  } // namespace

  double ContactProblem::asymmetry() const
  {
    const double greatest = compliance.cwiseAbs().maxCoeff();
    double worst = 0;
    for (Eigen::Index j = 0; j < size(); ++j)
      for (Eigen::Index i = 0; i < j; ++i)
        worst = std::max(worst, std::abs(compliance(i, j) - compliance(j, i)));
    return greatest > 0 ? worst / greatest : 0;
  }

  void SimplexSolver::set(const ContactProblem &problem)
  {
    const Eigen::Index n = problem.size();
    assert(n > 0 && problem.compliance.rows() == n && problem.compliance.cols() == n &&
           problem.lever.size() == n);
    assert(problem.gap.allFinite() && problem.lever.allFinite());
    problem_ = &problem;
    equilibrated_.compliance = &problem.compliance;
    equilibrated_.symmetric = problem.symmetric;
    for (Eigen::VectorXd *vector : { &equilibrated_.scale, &equilibrated_.gap, &equilibrated_.lever, &u_, &v_,
                                     &force_, &w_, &residual_ })
      vector->resize(n);
    next_.reserve(n);
    order_.reserve(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        assert(problem.compliance(i, i) > 0);
        equilibrated_.scale[i] = std::exp2(std::round(-0.5 * std::log2(problem.compliance(i, i))));
      }
    equilibrated_.sense = 0; // oriented by the first torque
    block_.forget();
  }

  /// Sense of the torque, levers in that sense, gaps from first touch.
  void SimplexSolver::orient(const double torque)
  {
    const double sense = torque < 0 ? -1 : 1;
    if (sense == equilibrated_.sense)
      return;
    const auto &g = problem_->gap, &l = problem_->lever;
    const Eigen::Index n = problem_->size();
    // First touch, of cells with a lever worth the name: one of next to none would put it far away, and the
    // digits with it.
    const double worth = 1e-3 * (sense * l).maxCoeff();
    double touch = infinity;
    for (Eigen::Index i = 0; i < n; ++i)
      if (sense * l[i] > 0 && sense * l[i] >= worth)
        touch = std::min(touch, g[i] / (sense * l[i]));
    has_lever_ = touch < infinity;
    equilibrated_.sense = sense;
    equilibrated_.first_touch = has_lever_ ? touch : 0;
    preloaded_ = false;
    for (Eigen::Index i = 0; i < n; ++i)
      {
        // Exact to the last bit: the difference is what carries the contact at small torques.
        const long double rigid = static_cast<long double>(equilibrated_.first_touch) * (sense * l[i]);
        double gap = static_cast<double>(g[i] - rigid);
        if (gap < 0 && gap > -4 * std::numeric_limits<double>::epsilon() * std::abs(g[i]))
          gap = 0; // the touching cell itself, after the rounding of the quotient
        equilibrated_.gap[i] = equilibrated_.scale[i] * gap;
        equilibrated_.lever[i] = equilibrated_.scale[i] * sense * l[i];
        preloaded_ = preloaded_ || gap < 0;
      }
  }

  /// Start without a neighbour: the quarter of the cells nearest to touching, and what is pressed already.
  void SimplexSolver::guess(std::vector<int> &active)
  {
    const auto &p = equilibrated_;
    const Eigen::Index n = p.size();
    order_.clear();
    for (Eigen::Index i = 0; i < n; ++i)
      if (p.lever[i] > 0 || p.gap[i] < 0)
        order_.emplace_back(p.gap[i] / p.scale[i], static_cast<int>(i));
    const auto count = std::min(order_.size(), static_cast<std::size_t>(std::max<Eigen::Index>(1, n / 4)));
    std::nth_element(order_.begin(), order_.begin() + (count - 1), order_.end());
    active.clear();
    for (std::size_t k = 0; k < count; ++k)
      active.push_back(order_[k].second);
    std::sort(active.begin(), active.end());
  }

  /// u_ = C_AA^-1 l, v_ = C_AA^-1 g of the factor in hand; l.u (the stiffness) and l.v.
  std::pair<double, double> SimplexSolver::respond(const std::vector<int> &active)
  {
    const auto &p = equilibrated_;
    const auto m = static_cast<Eigen::Index>(active.size());
    for (Eigen::Index k = 0; k < m; ++k)
      {
        u_[k] = p.lever[active[k]];
        v_[k] = p.gap[active[k]];
      }
    block_.solve(u_.head(m));
    block_.solve(v_.head(m));
    double slope = 0, preload = 0;
    for (Eigen::Index k = 0; k < m; ++k)
      {
        slope += p.lever[active[k]] * u_[k];
        preload += p.lever[active[k]] * v_[k];
      }
    return { slope, preload };
  }

  /// On success block_ holds the factor of the active cells, u_ and v_ its answers to l and g.
  bool SimplexSolver::block_pivoting(const double torque, const bool guessed, std::vector<int> &active,
                                     int &pivots)
  {
    const auto &p = equilibrated_;
    const Eigen::Index n = p.size();
    for (int iteration = 0; iteration < block_pivoting_cap; ++iteration)
      {
        const auto m = static_cast<Eigen::Index>(active.size());
        if (m == 0 || !block_.factor(p, active))
          return false;
        const auto [slope, preload] = respond(active);
        const auto u = u_.head(m), v = v_.head(m);
        auto force = force_.head(m);
        if (!(slope > 0))
          return false;
        const double theta = (torque + preload) / slope;
        force = theta * u - v;
        w_ = p.gap - theta * p.lever;
        p.add_deflection(active, force_, w_);

        // A guess is far off: in its first round only the deepest overlaps enter, or the set grows to twice
        // what is needed and the factors to eight times (measured: three times faster than without).
        const bool cautious = guessed && iteration == 0;
        const double entry = cautious ? 0.6 * (w_.array() / p.scale.array()).minCoeff() : 0;
        const double force_tolerance = Equilibrated::rounding * force.cwiseAbs().maxCoeff();
        next_.clear();
        Eigen::Index k = 0;
        int changes = 0;
        for (int i = 0; i < n; ++i)
          if (k < m && active[k] == i)
            {
              if (force[k] >= -force_tolerance)
                next_.push_back(i);
              else
                ++changes;
              ++k;
            }
          else if (w_[i] < entry * p.scale[i] && p.overlaps(i, w_[i], theta))
            {
              next_.push_back(i);
              ++changes;
            }
        pivots += changes;
        if (changes == 0 && !cautious)
          return true;
        active = next_;
      }
    return false;
  }

  /// The finite way: from no contact at first touch; where that overlaps (preload), the overlapping cells are
  /// released onto each other at fixed theta first. Then theta is followed until the torque is reached.
  bool SimplexSolver::walk(const double torque, std::vector<int> &active, double &theta, int &pivots)
  {
    ParametricPath path(equilibrated_);
    const auto &p = equilibrated_;
    active.clear();
    theta = 0;
    if (preloaded_)
      {
        const Eigen::VectorXd overlap = (-p.gap).cwiseMax(0);
        double s = 0;
        if (path.follow(active, p.gap + overlap, -overlap, s, 1, {}) != ParametricPath::End::reached)
          return false;
      }
    double moment = 0;
    if (!active.empty())
      {
        ActiveBlock block;
        if (!block.factor(p, active))
          return false;
        Eigen::VectorXd force = -p.gap(active);
        block.solve(force);
        moment = p.lever(active).dot(force);
        if (std::abs(moment) <= 1e-14 * p.lever(active).cwiseAbs().dot(force.cwiseAbs()))
          moment = 0;
      }
    if (moment != torque || torque != 0)
      {
        // (Unbounded cannot be: a positive lever carries any torque. Rounding that says so is a failure of
        // this attempt.)
        if (path.follow(active, p.gap, -p.lever, theta, torque >= moment ? infinity : -infinity, torque) !=
            ParametricPath::End::reached)
          return false;
      }
    pivots += path.pivots();
    std::sort(active.begin(), active.end());
    return true;
  }

  /// Forces of the active set, refined with residuals in extended precision. In one piece: every step works
  /// on the same few vectors, and none is of use alone.
  void SimplexSolver::finish(const double torque, double theta, const int pivots, ContactSolution &solution)
  {
    const auto &p = equilibrated_;
    const std::vector<int> &active = solution.active;
    const auto m = static_cast<Eigen::Index>(active.size());
    if (block_.cells() != active && !block_.factor(p, active))
      return;
    const auto [slope, preload] = respond(active);
    const auto u = u_.head(m), v = v_.head(m);
    auto force = force_.head(m), residual = residual_.head(m);
    const bool loaded = slope > 0; // else theta is free here: that of the path
    if (loaded)
      theta = (torque + preload) / slope;
    force = theta * u - v;

    // Bordered refinement on the data as given, residuals and theta in extended precision: one step, more
    // where a singular block was regularised.
    long double rotation = static_cast<long double>(p.first_touch) + theta;
    const int steps = p.regularisation > 0 ? 4 : 1;
    for (int step = 0; step < steps && m > 0; ++step)
      {
        long double missing = torque;
        for (Eigen::Index k = 0; k < m; ++k)
          missing -= static_cast<long double>(p.lever[active[k]]) * force[k];
        for (Eigen::Index k = 0; k < m; ++k)
          {
            const int cell = active[k];
            const double factor = p.scale[cell];
            const double *column = problem_->compliance.col(cell).data(); // of the symmetric matrix: its row
            long double sum =
                rotation * p.lever[cell] - static_cast<long double>(factor) * problem_->gap[cell];
            if (p.symmetric)
              for (Eigen::Index j = 0; j < m; ++j)
                sum -= static_cast<long double>(factor * p.scale[active[j]] * column[active[j]]) * force[j];
            else
              for (Eigen::Index j = 0; j < m; ++j)
                sum -= static_cast<long double>(factor * p.scale[active[j]] *
                                                problem_->compliance(cell, active[j])) *
                       force[j];
            residual[k] = static_cast<double>(sum);
          }
        block_.solve(residual);
        double correction = 0;
        if (loaded)
          {
            double answered = 0;
            for (Eigen::Index k = 0; k < m; ++k)
              answered += p.lever[active[k]] * residual[k];
            correction = (static_cast<double>(missing) - answered) / slope;
          }
        force += residual + correction * u;
        rotation += correction;
      }

    // Refinement on a nearly singular block may turn forces negative: then this is not the active set.
    if (m > 0 && force.minCoeff() < -1e-11 * force.maxCoeff())
      return;
    solution.status = Status::solved;
    solution.torque = p.sense * torque;
    solution.theta = p.sense * static_cast<double>(rotation);
    solution.stiffness = loaded ? slope : 0;
    solution.pivots = pivots;
    solution.regularisation = p.regularisation;
    solution.force.resize(p.size());
    solution.force.setZero();
    for (Eigen::Index k = 0; k < m; ++k)
      solution.force[active[k]] = std::max(0.0, force[k] * p.scale[active[k]]);
  }

  /// No cell overlaps and no loaded one is apart, to half the certificate's gate: decides only whether to try
  /// again.
  bool SimplexSolver::plausible(const ContactSolution &solution)
  {
    const ContactProblem &p = *problem_;
    w_.setZero();
    for (const int k : solution.active)
      w_ += solution.force[k] * p.compliance.col(k);
    double deflection = w_.cwiseAbs().maxCoeff(), greatest_gap = p.gap.cwiseAbs().maxCoeff();
    for (const int k : solution.active)
      if (solution.force[k] > 0)
        deflection = std::max(deflection, std::abs(p.gap[k] - solution.theta * p.lever[k]));
    w_ += p.gap - solution.theta * p.lever;
    const double allowed =
        std::max(0.5e-10 * deflection, 50 * std::numeric_limits<double>::epsilon() * greatest_gap);
    for (const int k : solution.active)
      if (solution.force[k] > 0)
        w_[k] = -std::abs(w_[k]);
    return w_.minCoeff() >= -allowed;
  }

  void SimplexSolver::attempt(const double torque, const std::vector<int> &start, const bool pivot_blocks,
                              ContactSolution &solution)
  {
    assert(problem_ && std::isfinite(torque));
    solution.status = Status::failed;
    solution.torque = torque;
    solution.pivots = 0;
    solution.active.clear();
    orient(torque);
    if (!has_lever_ && torque == 0)
      {
        // Nothing to reach in this sense: first touch is that of the other flank.
        equilibrated_.sense = 0;
        orient(-1);
      }
    const double size = std::abs(torque);
    if (!has_lever_ && size > 0)
      {
        solution.status = Status::infeasible;
        return;
      }
    for (const double regularisation : regularisations)
      for (const bool blocks : { true, false })
        {
          if (blocks && (size == 0 || !pivot_blocks))
            continue;
          equilibrated_.regularisation = regularisation;
          block_.forget();
          double theta = 0;
          int pivots = 0;
          bool found = false;
          if (blocks)
            {
              if (start.empty())
                guess(solution.active);
              else
                {
                  solution.active = start;
                  std::sort(solution.active.begin(), solution.active.end());
                }
              found = block_pivoting(size, start.empty(), solution.active, pivots);
            }
          else
            found = walk(size, solution.active, theta, pivots);
          solution.status = Status::failed;
          if (found)
            finish(size, theta, pivots, solution);
          // Block pivoting has seen every cell on the plain problem; what came another way is looked at
          // again.
          if (solution.status == Status::solved && ((blocks && regularisation == 0) || plausible(solution)))
            {
              equilibrated_.regularisation = 0;
              return;
            }
          solution.status = Status::failed;
        }
    equilibrated_.regularisation = 0;
    solution.active.clear();
  }

  void SimplexSolver::solve(const double torque, const std::vector<int> &start, ContactSolution &solution)
  {
    attempt(torque, start, true, solution);
  }

  ContactSolution SimplexSolver::solve(const double torque, const std::vector<int> &start)
  {
    ContactSolution solution;
    attempt(torque, start, true, solution);
    return solution;
  }

  ContactSolution SimplexSolver::solve_by_path(const double torque)
  {
    ContactSolution solution;
    attempt(torque, {}, false, solution);
    return solution;
  }

  void SimplexSolver::factor_block_of(const ContactSolution &solution)
  {
    // (Found in another order of the cells, a block may need a little more than it did there.)
    bool factored = block_.cells() == solution.active && solution.regularisation == 0;
    for (const double regularisation : regularisations)
      if (!factored && regularisation >= solution.regularisation)
        {
          equilibrated_.regularisation = regularisation;
          factored = block_.factor(equilibrated_, solution.active);
        }
    equilibrated_.regularisation = 0;
    assert(factored);
  }

  Sensitivities SimplexSolver::sensitivities(const ContactSolution &solution)
  {
    orient(solution.torque);
    const auto &p = equilibrated_;
    const auto &active = solution.active;
    const auto m = static_cast<Eigen::Index>(active.size());
    Sensitivities result;
    Eigen::VectorXd u = p.lever(active), transposed = u;
    factor_block_of(solution);
    block_.solve(u);
    block_.solve_transposed(transposed);
    const double slope = p.lever(active).dot(u);
    for (Eigen::VectorXd *vector : { &result.force_by_torque, &result.theta_by_gap })
      *vector = Eigen::VectorXd::Zero(p.size());
    // C df = dtheta l - dg,  l . df = dT; the sense of the torque turns theta and l together.
    if (slope > 0)
      for (Eigen::Index k = 0; k < m; ++k)
        {
          const int i = active[k];
          const double scale = p.scale[i] * p.sense / slope;
          result.force_by_torque[i] = scale * u[k];
          result.theta_by_gap[i] = scale * transposed[k];
        }
    return result;
  }

  /// f = C_AA^-1 (theta l - g), where C_AA^-1 l is df/dT times the stiffness.
  Eigen::VectorXd SimplexSolver::forces_by_gap(const ContactSolution &solution,
                                               const Sensitivities &sensitivities,
                                               const Eigen::VectorXd &weight)
  {
    const Eigen::VectorXd scale = equilibrated_.scale(solution.active);
    Eigen::VectorXd x = scale.cwiseProduct(weight(solution.active));
    factor_block_of(solution);
    block_.solve_transposed(x);
    Eigen::VectorXd result =
        solution.stiffness * weight.dot(sensitivities.force_by_torque) * sensitivities.theta_by_gap;
    result(solution.active) -= scale.cwiseProduct(x);
    return result;
  }
} // namespace flank
