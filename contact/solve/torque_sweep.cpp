// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/simplex_solver.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace flank
{
  double TorqueCurve::theta_at(const double torque) const
  {
    const auto above =
        std::upper_bound(points.begin() + 1, points.end() - 1, torque, [](const double t, const Breakpoint &p) { return t < p.torque; });
    const auto below = above - 1;
    return below->stiffness > 0 ? below->theta + (torque - below->torque) / below->stiffness : below->theta;
  }

  double TorqueCurve::stiffness_at(const double torque) const
  {
    return (std::upper_bound(points.begin() + 1, points.end() - 1, torque,
                             [](const double t, const Breakpoint &p) { return t < p.torque; }) -
            1)
        ->stiffness;
  }

  /// The parametric sweep on an active block alone, downwards: cells only leave. The explicit inverse (lower triangle)
  /// shrinks by one symmetric rank-one step a corner. Symmetric problems only; whoever calls checks the other cells.
  SimplexSolver::Descent SimplexSolver::descend(const std::vector<int> &active, const double high, const double low)
  {
    const auto     &p = equilibrated_;
    auto            m = static_cast<Eigen::Index>(active.size());
    Eigen::MatrixXd inverse(m, m);
    block_.invert(inverse);
    std::vector<int> cells = active, left;
    Eigen::VectorXd  l = p.lever(active), u = inverse * l, v = inverse * p.gap(active), column(m);
    Descent          result;
    double           slope = l.dot(u), theta = (high + l.dot(v)) / slope;
    result.corners.push_back({ high, theta, slope, -1 });
    while (true)
      {
        const double floor = slope > 0 ? (low + l.head(m).dot(v.head(m))) / slope : theta;
        double       next  = floor;
        Eigen::Index k     = -1;
        for (Eigen::Index i = 0; i < m; ++i)
          if (u[i] > 0)
            {
              const double at = std::min(theta, v[i] / u[i]);
              if (at > next || (at == next && k >= 0 && cells[i] < cells[k]))
                {
                  next = at;
                  k    = i;
                }
            }
        theta = next;
        if (k < 0 || m == 1)
          {
            theta = floor;
            result.corners.push_back({ low, theta, slope, -1 });
            break;
          }
        result.corners.push_back({ slope * theta - l.head(m).dot(v.head(m)), theta, slope, cells[k] });
        left.push_back(cells[k]);
        for (Eigen::Index i = 0; i < m; ++i)
          column[i] = i < k ? inverse(k, i) : inverse(i, k);
        const double pivot = column[k], uk = u[k] / pivot, vk = v[k] / pivot;
        u.head(m) -= uk * column.head(m);
        v.head(m) -= vk * column.head(m);
        for (Eigen::Index j = 0; j < m; ++j)
          inverse.col(j).segment(j, m - j) -= (column[j] / pivot) * column.segment(j, m - j);
        // The last one takes the place of the one that left.
        const Eigen::Index last = --m;
        for (Eigen::Index i = 0; i < k; ++i)
          inverse(k, i) = inverse(last, i);
        for (Eigen::Index i = k + 1; i < last; ++i)
          inverse(i, k) = inverse(last, i);
        inverse(k, k) = inverse(last, last);
        cells[k] = cells[last], u[k] = u[last], v[k] = v[last], l[k] = l[last];
        slope = l.head(m).dot(u.head(m));
      }
    result.order.assign(cells.begin(), cells.begin() + m);
    std::sort(result.order.begin(), result.order.end());
    result.order.insert(result.order.end(), left.rbegin(), left.rend());
    return result;
  }

  std::vector<ContactSolution> SimplexSolver::sweep(const std::vector<double> &torques, const std::vector<int> &start,
                                                    const std::function<bool(const ContactSolution &)> &goes_on)
  {
    std::vector<ContactSolution> solutions(torques.size());
    std::vector<std::size_t>     order(torques.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) { return torques[a] > torques[b]; });
    if (torques.empty())
      return solutions;
    solve(torques[order.front()], start, solutions[order.front()]);
    const ContactSolution &greatest = solutions[order.front()];
    if (goes_on && !goes_on(greatest))
      return solutions;

    // Those the block of the greatest torque can serve: same sense, and nothing special about the block.
    std::vector<std::size_t> rest;
    const double             low_end = torques[order.back()];
    const bool served = greatest.status == Status::solved && greatest.torque > 0 && low_end > 0 && greatest.regularisation == 0 &&
                        problem_->symmetric && !preloaded_;
    if (served && order.size() > 1)
      {
        const auto   &p    = equilibrated_;
        const Descent down = descend(greatest.active, greatest.torque, low_end);
        const auto    m    = static_cast<Eigen::Index>(down.order.size());
        if (!block_.factor(p, down.order))
          assert(false);
        // One factor serves every torque: prefixes of L^-1 l and L^-1 g, prefix sums for theta.
        Eigen::VectorXd la = p.lever(down.order), lg = p.gap(down.order), sum_ll(m + 1), sum_lg(m + 1);
        block_.lower(m).solveInPlace(la);
        block_.lower(m).solveInPlace(lg);
        sum_ll[0] = sum_lg[0] = 0;
        for (Eigen::Index k = 0; k < m; ++k)
          {
            sum_ll[k + 1] = sum_ll[k] + la[k] * la[k];
            sum_lg[k + 1] = sum_lg[k] + la[k] * lg[k];
          }
        const auto                n_low  = static_cast<Eigen::Index>(order.size()) - 1;
        Eigen::MatrixXd           forces = Eigen::MatrixXd::Zero(m, n_low), w(p.size(), n_low);
        Eigen::VectorXd           theta(n_low);
        std::vector<Eigen::Index> size(n_low);
        std::size_t               corner = 1;
        Eigen::Index              k      = m;
        for (Eigen::Index i = 0; i < n_low; ++i)
          {
            const double torque = torques[order[i + 1]];
            for (; corner + 1 < down.corners.size() && down.corners[corner].torque > torque; ++corner)
              --k;
            size[i]    = k;
            theta[i]   = (torque + sum_lg[k]) / sum_ll[k];
            auto force = forces.col(i).head(k);
            force      = theta[i] * la.head(k) - lg.head(k);
            block_.upper(k).solveInPlace(force);
          }
        // All cells at all torques: one product.
        Eigen::MatrixXd scaled = forces;
        for (Eigen::Index j = 0; j < m; ++j)
          scaled.row(j) *= p.scale[down.order[j]];
        Eigen::MatrixXd columns(p.size(), m);
        for (Eigen::Index j = 0; j < m; ++j)
          columns.col(j) = problem_->compliance.col(down.order[j]);
        w.noalias() = columns * scaled;
        for (Eigen::Index i = 0; i < n_low; ++i)
          {
            ContactSolution &s     = solutions[order[i + 1]];
            const auto       force = forces.col(i).head(size[i]);
            bool             holds = force.minCoeff() >= -1e-13 * force.maxCoeff();
            std::vector<int> active(down.order.begin(), down.order.begin() + size[i]);
            std::sort(active.begin(), active.end());
            std::size_t next = 0;
            for (Eigen::Index j = 0; j < p.size() && holds; ++j)
              {
                if (next < active.size() && active[next] == j)
                  {
                    ++next;
                    continue;
                  }
                const double rigid = p.gap[j] - theta[i] * p.lever[j];
                holds              = p.scale[j] * w(j, i) + rigid >= -1e-13 * (std::abs(p.gap[j]) + std::abs(theta[i] * p.lever[j]));
              }
            if (!holds)
              {
                rest.push_back(order[i + 1]);
                s.active = active; // a good start
                continue;
              }
            s.status    = Status::solved;
            s.torque    = torques[order[i + 1]];
            s.theta     = p.first_touch + theta[i];
            s.stiffness = sum_ll[size[i]];
            s.pivots    = static_cast<int>(m - size[i]);
            s.force     = Eigen::VectorXd::Zero(p.size());
            for (Eigen::Index j = 0; j < size[i]; ++j)
              s.force[down.order[j]] = std::max(0.0, force[j] * p.scale[down.order[j]]);
            s.active = std::move(active);
          }
      }
    else
      rest.assign(order.begin() + 1, order.end());
    const ContactSolution *neighbour = &greatest;
    for (const std::size_t i : rest)
      {
        const std::vector<int> near = solutions[i].active.empty() ? neighbour->active : solutions[i].active;
        solve(torques[i], near, solutions[i]);
        neighbour = &solutions[i];
      }
    return solutions;
  }

  TorqueCurve SimplexSolver::curve(const double low, const double high, const std::vector<int> &start)
  {
    assert(low >= 0 && low < high);
    TorqueCurve           result;
    const ContactSolution top = solve(high, start);
    result.status             = top.status;
    if (top.status != Status::solved)
      return result;
    // Down from the greatest torque over all cells, so that one that enters on the way is seen.
    const auto             &p = equilibrated_;
    ParametricPath          path(p);
    std::vector<int>        active = top.active;
    std::vector<Breakpoint> down;
    double                  theta = p.sense * top.theta - p.first_touch;
    const auto              end =
        path.follow(active, p.gap, -p.lever, theta, low > 0 || preloaded_ ? -std::numeric_limits<double>::infinity() : 0.0, low, &down);
    if (end == ParametricPath::End::lost)
      {
        result.status = Status::failed;
        return result;
      }
    const auto slope_of = [&](const std::vector<int> &cells) {
      ActiveBlock block;
      if (cells.empty() || !block.factor(p, cells))
        return 0.0;
      Eigen::VectorXd u = p.lever(cells);
      block.solve(u);
      return p.lever(cells).dot(u);
    };
    // A corner met on the way down closes the piece above it: its slope is the one recorded there.
    result.points.push_back({ low, p.first_touch + theta, slope_of(active), -1 });
    for (auto corner = down.rbegin(); corner != down.rend(); ++corner)
      result.points.push_back({ corner->torque, p.first_touch + corner->theta, corner->stiffness, corner->cell });
    result.points.push_back({ high, top.theta, top.stiffness, -1 });
    return result;
  }
} // namespace flank
