// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/simplex_solver.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  SimplexSolver::SimplexSolver(const ContactProblem &problem)
      : problem_(problem)
  {
    const Eigen::Index n = problem.size();
    FLANK_ASSERT(problem.compliance.rows() == n && problem.compliance.cols() == n && problem.lever.size() == n && n > 0, "sizes");
    if (problem.lever.maxCoeff() <= 0)
      throw InputError("no contact cell can carry a torque in the direction of load: every lever is <= 0");
    scale_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        FLANK_ASSERT(problem.compliance(i, i) > 0, "self compliance is positive");
        scale_[i] = std::exp2(std::round(-0.5 * std::log2(problem.compliance(i, i))));
      }
    compliance_ = scale_.asDiagonal() * problem.compliance * scale_.asDiagonal();
    gap_        = scale_.cwiseProduct(problem.gap);
    lever_      = scale_.cwiseProduct(problem.lever);
  }

  namespace
  {
    /// theta and f of one active set at one torque.
    struct ActiveSolution
    {
      double          theta, slope; ///< slope = la.la = dT/dtheta
      Eigen::VectorXd force;
    };

    ActiveSolution solve_active(const Eigen::MatrixXd &c, const Eigen::VectorXd &g, const Eigen::VectorXd &l, const double torque)
    {
      const Eigen::LLT<Eigen::MatrixXd> factor(c);
      if (factor.info() != Eigen::Success)
        throw ComputationError(fmt::format("the compliance of {} active cells is not positive definite", g.size()));
      const Eigen::VectorXd la = factor.matrixL().solve(l), lg = factor.matrixL().solve(g);
      const double          slope = la.squaredNorm(), theta = (torque + la.dot(lg)) / slope;
      return { theta, slope, factor.matrixU().solve(theta * la - lg) };
    }
  } // namespace

  bool SimplexSolver::block_pivoting(const double torque, std::vector<int> &active, int &pivots) const
  {
    const int n = static_cast<int>(problem_.size());
    if (active.empty())
      {
        // The cells a rigid approach by a Hertz-like guess would overlap; any start is allowed.
        std::vector<int> order(n);
        for (int i = 0; i < n; ++i)
          order[i] = i;
        std::sort(order.begin(), order.end(), [&](int a, int b) { return problem_.gap[a] < problem_.gap[b]; });
        for (int i = 0; i < std::max(1, n / 4); ++i)
          if (lever_[order[i]] > 0)
            active.push_back(order[i]);
        std::sort(active.begin(), active.end());
        if (active.empty())
          return false;
      }
    constexpr int iteration_cap = 30;
    for (int iteration = 0; iteration < iteration_cap; ++iteration)
      {
        if (active.empty() || lever_(active).maxCoeff() <= 0)
          return false;
        const ActiveSolution s = solve_active(compliance_(active, active), gap_(active), lever_(active), torque);
        Eigen::VectorXd      w = gap_ - s.theta * lever_;
        for (std::size_t k = 0; k < active.size(); ++k)
          w.noalias() += s.force[k] * compliance_.col(active[k]);
        const double     force_tolerance = 1e-13 * s.force.cwiseAbs().maxCoeff();
        std::vector<int> next;
        std::size_t      k       = 0;
        int              changes = 0;
        for (int i = 0; i < n; ++i)
          if (k < active.size() && active[k] == i)
            {
              if (s.force[k] >= -force_tolerance)
                next.push_back(i);
              else
                ++changes;
              ++k;
            }
          else if (w[i] < -1e-13 * (std::abs(gap_[i]) + std::abs(s.theta * lever_[i])))
            {
              next.push_back(i);
              ++changes;
            }
        pivots += changes;
        if (changes == 0)
          return true;
        active.swap(next);
      }
    return false;
  }

  /// Cholesky factor of the active block that grows and shrinks by one cell, with L^-1 l and L^-1 g kept beside it.
  struct SimplexSolver::State
  {
    const Eigen::MatrixXd &c;
    const Eigen::VectorXd &g, &l;
    Eigen::MatrixXd        factor;
    Eigen::VectorXd        la, lg;
    std::vector<int>       cells;

    State(const Eigen::MatrixXd &c, const Eigen::VectorXd &g, const Eigen::VectorXd &l)
        : c(c)
        , g(g)
        , l(l)
    {
    }

    Eigen::Index size() const { return static_cast<Eigen::Index>(cells.size()); }
    auto         lower() { return factor.topLeftCorner(size(), size()).triangularView<Eigen::Lower>(); }

    void append(const int cell)
    {
      const Eigen::Index m = size();
      if (factor.rows() <= m)
        {
          factor.conservativeResize(2 * m + 16, 2 * m + 16);
          la.conservativeResize(2 * m + 16);
          lg.conservativeResize(2 * m + 16);
        }
      Eigen::VectorXd y(m);
      for (Eigen::Index i = 0; i < m; ++i)
        y[i] = c(cells[i], cell);
      if (m > 0)
        lower().solveInPlace(y);
      const double pivot = c(cell, cell) - y.squaredNorm();
      if (!(pivot > 0))
        throw ComputationError(fmt::format("contact compliance loses definiteness when cell {} enters {} active ones", cell, m));
      const double d        = std::sqrt(pivot);
      factor.row(m).head(m) = y.transpose();
      factor(m, m)          = d;
      la[m]                 = (l[cell] - y.dot(la.head(m))) / d;
      lg[m]                 = (g[cell] - y.dot(lg.head(m))) / d;
      cells.push_back(cell);
    }

    void remove(const Eigen::Index k)
    {
      const Eigen::Index m = size();
      for (Eigen::Index i = k; i + 1 < m; ++i)
        factor.row(i).head(i + 2) = factor.row(i + 1).head(i + 2);
      for (Eigen::Index i = k; i + 1 < m; ++i)
        {
          const double a = factor(i, i), b = factor(i, i + 1), r = std::hypot(a, b), cs = a / r, sn = b / r;
          for (Eigen::Index row = i; row + 1 < m; ++row)
            {
              const double x = factor(row, i), y = factor(row, i + 1);
              factor(row, i)     = cs * x + sn * y;
              factor(row, i + 1) = -sn * x + cs * y;
            }
        }
      cells.erase(cells.begin() + k);
      // Row k is gone from the equations, so what is left of the right sides is read anew.
      for (auto &[vector, source] : { std::pair<Eigen::VectorXd *, const Eigen::VectorXd *>{ &la, &l }, { &lg, &g } })
        {
          for (Eigen::Index i = 0; i < size(); ++i)
            (*vector)[i] = (*source)[cells[i]];
          if (size() > 0)
            {
              Eigen::VectorXd head = vector->head(size());
              lower().solveInPlace(head);
              vector->head(size()) = head;
            }
        }
    }
  };

  int SimplexSolver::follow(std::vector<int> &active, const std::vector<int> &cells, const double from, const double to,
                            const bool from_first_touch) const
  {
    State state(compliance_, gap_, lever_);
    if (from_first_touch)
      {
        int    first = -1;
        double least = std::numeric_limits<double>::infinity();
        for (const int i : cells)
          if (lever_[i] > 0 && gap_[i] / lever_[i] < least)
            {
              least = gap_[i] / lever_[i];
              first = i;
            }
        FLANK_ASSERT(first >= 0, "a positive lever");
        state.append(first);
      }
    else
      for (const int i : active)
        state.append(i);

    const double      sense  = to >= from ? 1 : -1;
    double            torque = from;
    int               pivots = 0;
    const int         bound  = 50 * static_cast<int>(cells.size()) + 1000;
    std::vector<char> is_active(problem_.size(), 0);
    for (const int i : state.cells)
      is_active[i] = 1;

    while (true)
      {
        const Eigen::Index    m  = state.size();
        const Eigen::VectorXd la = state.la.head(m), lg = state.lg.head(m);
        const double          slope = la.squaredNorm(), theta = (torque + la.dot(lg)) / slope, theta_rate = sense / slope;
        const Eigen::VectorXd force      = state.lower().transpose().solve(theta * la - lg),
                              force_rate = state.lower().transpose().solve(theta_rate * la);

        double     step     = sense * (to - torque);
        int        chosen   = -1;
        const auto consider = [&](const double value, const double rate, const int cell) {
          const double t = std::max(0.0, value) / -rate;
          if (t < step * (1 - 1e-14) || (chosen >= 0 && t <= step * (1 + 1e-14) && cell < chosen))
            {
              step   = std::min(step, t);
              chosen = cell;
            }
        };
        const double rate_tolerance = 1e-12 * force_rate.cwiseAbs().maxCoeff();
        for (Eigen::Index k = 0; k < m; ++k)
          if (force_rate[k] < -rate_tolerance)
            consider(force[k], force_rate[k], state.cells[k]);
        for (const int j : cells)
          if (!is_active[j])
            {
              double deflection = 0, deflection_rate = 0;
              for (Eigen::Index k = 0; k < m; ++k)
                {
                  deflection += compliance_(state.cells[k], j) * force[k];
                  deflection_rate += compliance_(state.cells[k], j) * force_rate[k];
                }
              const double rate = deflection_rate - theta_rate * lever_[j];
              if (rate < -1e-12 * (std::abs(deflection_rate) + std::abs(theta_rate * lever_[j])))
                consider(deflection + gap_[j] - theta * lever_[j], rate, j);
            }
        if (chosen < 0)
          break;
        torque += sense * step;
        if (is_active[chosen])
          state.remove(std::find(state.cells.begin(), state.cells.end(), chosen) - state.cells.begin());
        else
          state.append(chosen);
        is_active[chosen] ^= 1;
        if (++pivots > bound || state.cells.empty())
          throw ComputationError(fmt::format("the parametric sweep did not end after {} pivots ({} cells, torque {:.6g} of {:.6g} N mm)",
                                             pivots, cells.size(), torque, to));
      }
    active = state.cells;
    std::sort(active.begin(), active.end());
    return pivots;
  }

  ContactSolution SimplexSolver::finish(const double torque, std::vector<int> active, const int pivots) const
  {
    // The final factorisation depends on the active set alone; one bordered refinement step with residuals in extended precision.
    const Eigen::MatrixXd             c = compliance_(active, active);
    const Eigen::VectorXd             g = gap_(active), l = lever_(active);
    const Eigen::LLT<Eigen::MatrixXd> factor(c);
    if (factor.info() != Eigen::Success)
      throw ComputationError(fmt::format("the compliance of {} active cells is not positive definite", active.size()));
    const Eigen::VectorXd la = factor.matrixL().solve(l), lg = factor.matrixL().solve(g);
    const double          slope = la.squaredNorm();
    double                theta = (torque + la.dot(lg)) / slope;
    Eigen::VectorXd       f     = factor.matrixU().solve(theta * la - lg);
    for (int step = 0; step < 2; ++step)
      {
        const Eigen::Index m = f.size();
        Eigen::VectorXd    residual(m);
        long double        balance = torque;
        for (Eigen::Index i = 0; i < m; ++i)
          {
            long double r = static_cast<long double>(theta) * l[i] - g[i];
            for (Eigen::Index k = 0; k < m; ++k)
              r -= static_cast<long double>(c(k, i)) * f[k];
            residual[i] = static_cast<double>(r);
            balance -= static_cast<long double>(l[i]) * f[i];
          }
        const Eigen::VectorXd lr     = factor.matrixL().solve(residual);
        const double          change = (static_cast<double>(balance) - la.dot(lr)) / slope;
        theta += change;
        f += factor.matrixU().solve(change * la + lr);
      }
    ContactSolution result;
    result.torque    = torque;
    result.theta     = theta;
    result.stiffness = slope;
    result.force     = Eigen::VectorXd::Zero(problem_.size());
    for (std::size_t k = 0; k < active.size(); ++k)
      result.force[active[k]] = std::max(0.0, f[k] * scale_[active[k]]);
    result.active = std::move(active);
    result.pivots = pivots;
    return result;
  }

  ContactSolution SimplexSolver::solve(const double torque, const std::vector<int> &start) const
  {
    FLANK_ASSERT(torque > 0, fmt::format("{}", torque));
    std::vector<int> active = start;
    int              pivots = 0;
    bool             solved = false;
    try
      {
        solved = block_pivoting(torque, active, pivots);
      }
    catch (const ComputationError &)
      {
      } // a block that is not definite: the sweep below never forms it
    if (!solved)
      {
        std::vector<int> cells(problem_.size());
        for (std::size_t i = 0; i < cells.size(); ++i)
          cells[i] = static_cast<int>(i);
        pivots += follow(active, cells, 0, torque, true);
      }
    return finish(torque, std::move(active), pivots);
  }

  std::vector<ContactSolution> SimplexSolver::sweep(const std::vector<double> &torques, const std::vector<int> &start) const
  {
    const auto                   n = static_cast<int>(problem_.size());
    std::vector<std::size_t>     order(torques.size());
    std::vector<ContactSolution> solutions(torques.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      order[i] = i;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return torques[a] > torques[b]; });
    solutions[order[0]]    = solve(torques[order[0]], start);
    std::vector<int> block = solutions[order[0]].active;

    for (int round = 0; round <= n; ++round)
      {
        for (std::size_t i = 1; i < order.size(); ++i)
          {
            const ContactSolution &previous = solutions[order[i - 1]];
            std::vector<int>       active   = previous.active;
            const int              pivots   = follow(active, block, previous.torque, torques[order[i]], false);
            solutions[order[i]]             = finish(torques[order[i]], std::move(active), pivots);
          }
        // All cells at all torques at once.
        Eigen::MatrixXd forces(block.size(), order.size());
        for (std::size_t i = 0; i < order.size(); ++i)
          forces.col(i) = solutions[order[i]].force(block).cwiseQuotient(scale_(block));
        const Eigen::MatrixXd deflection = compliance_(Eigen::all, block) * forces;
        std::vector<char>     in_block(n, 0);
        for (const int i : block)
          in_block[i] = 1;
        bool violated = false;
        for (int j = 0; j < n; ++j)
          for (std::size_t i = 0; i < order.size() && !in_block[j]; ++i)
            {
              const double theta = solutions[order[i]].theta;
              if (deflection(j, i) + gap_[j] - theta * lever_[j] < -1e-13 * (std::abs(gap_[j]) + std::abs(theta * lever_[j])))
                {
                  block.push_back(j);
                  in_block[j] = 1;
                  violated    = true;
                }
            }
        if (!violated)
          break;
        std::sort(block.begin(), block.end());
      }
    return solutions;
  }
} // namespace flank
