// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/contact/rigid_body.hpp"

#include "contact/solve/parametric_path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace flank
{
  namespace
  {
    struct Bordered
    {
      Equilibrated problem; ///< gaps as given, no lever
      const Eigen::MatrixXd &levers;
      Eigen::MatrixXd scaled_levers; ///< D L
      const Eigen::VectorXd &moments;

      /// theta and f' of an active set; false where its levers do not hold every unknown.
      bool solve(const std::vector<int> &active, Eigen::VectorXd &theta, Eigen::VectorXd &force) const
      {
        ActiveBlock block;
        if (static_cast<Eigen::Index>(active.size()) < moments.size() || !block.factor(problem, active))
          return false;
        const Eigen::MatrixXd l = scaled_levers(active, Eigen::all);
        Eigen::MatrixXd u = l;
        for (Eigen::Index c = 0; c < u.cols(); ++c)
          block.solve(u.col(c));
        Eigen::VectorXd v = problem.gap(active);
        block.solve(v);
        const Eigen::LDLT<Eigen::MatrixXd> slope(l.transpose() * u);
        if (slope.info() != Eigen::Success || !(slope.rcond() > 1e-14))
          return false;
        theta = slope.solve(moments + l.transpose() * v);
        force = u * theta - v;
        // One bordered refinement step, residuals in extended precision.
        Eigen::VectorXd residual(force.size()), missing = moments;
        for (Eigen::Index i = 0; i < force.size(); ++i)
          {
            long double sum = -problem.gap[active[i]];
            for (Eigen::Index c = 0; c < l.cols(); ++c)
              sum += static_cast<long double>(l(i, c)) * theta[c];
            for (Eigen::Index j = 0; j < force.size(); ++j)
              sum -= static_cast<long double>(problem.entry(active[i], active[j])) * force[j];
            residual[i] = static_cast<double>(sum);
          }
        for (Eigen::Index c = 0; c < l.cols(); ++c)
          {
            long double sum = moments[c];
            for (Eigen::Index i = 0; i < force.size(); ++i)
              sum -= static_cast<long double>(l(i, c)) * force[i];
            missing[c] = static_cast<double>(sum);
          }
        block.solve(residual);
        const Eigen::VectorXd correction = slope.solve(missing - l.transpose() * residual);
        theta += correction;
        force += residual + u * correction;
        return theta.allFinite() && force.allFinite();
      }

      /// Cells that violate their condition change sides; the number of changes.
      int exchange(std::vector<int> &active, const Eigen::VectorXd &theta, const Eigen::VectorXd &force) const
      {
        const Eigen::VectorXd rigid = scaled_levers * theta;
        Eigen::VectorXd w = problem.gap - rigid;
        problem.add_deflection(active, force, w);
        std::vector<int> next;
        std::size_t k = 0;
        int changes = 0;
        for (int i = 0; i < problem.size(); ++i)
          if (k < active.size() && active[k] == i)
            {
              if (force[static_cast<Eigen::Index>(k)] >= -1e-13 * force.cwiseAbs().maxCoeff())
                next.push_back(i);
              else
                ++changes;
              ++k;
            }
          else if (w[i] < -1e-13 * (std::abs(problem.gap[i]) + std::abs(rigid[i])))
            {
              next.push_back(i);
              ++changes;
            }
        active.swap(next);
        return changes;
      }
    };
  } // namespace

  /// Longer than a screen: principal pivoting and what it falls back to, on one set of quantities.
  RigidBodySolution solve_rigid_body(const Eigen::MatrixXd &compliance, const Eigen::VectorXd &gap,
                                     const Eigen::MatrixXd &levers, const Eigen::VectorXd &moments,
                                     const std::vector<int> &start)
  {
    const Eigen::Index n = gap.size(), m = moments.size();
    assert(compliance.rows() == n && compliance.cols() == n && levers.rows() == n && levers.cols() == m &&
           m > 0);
    Bordered system{ {}, levers, {}, moments };
    system.problem.compliance = &compliance;
    system.problem.scale = compliance.diagonal().unaryExpr(
        [](const double c) { return std::exp2(std::round(-0.5 * std::log2(c))); });
    system.problem.gap = system.problem.scale.cwiseProduct(gap);
    system.problem.lever = Eigen::VectorXd::Zero(n);
    system.scaled_levers = system.problem.scale.asDiagonal() * levers;

    RigidBodySolution result;
    Eigen::VectorXd theta, force;
    const auto pivoting = [&](std::vector<int> active) {
      for (int iteration = 0; iteration < 30; ++iteration)
        {
          const std::vector<int> present = active;
          if (!system.solve(active, theta, force))
            return false;
          const int changes = system.exchange(active, theta, force);
          result.pivots += changes;
          if (changes == 0)
            {
              result.status = Status::solved;
              result.theta = theta;
              result.force = Eigen::VectorXd::Zero(n);
              for (std::size_t k = 0; k < present.size(); ++k)
                result.force[present[k]] =
                    std::max(0.0, force[static_cast<Eigen::Index>(k)] * system.problem.scale[present[k]]);
              result.active = present;
              return true;
            }
        }
      return false;
    };
    std::vector<int> all(n);
    for (Eigen::Index i = 0; i < n; ++i)
      all[i] = static_cast<int>(i);
    if (pivoting(start.empty() ? all : start))
      return result;

    // Springs k_c on the unknowns, L' f + k theta = T: theta drops out, w = (C + L k^-1 L') f + g - L k^-1 T.
    Eigen::VectorXd stiffness(m);
    for (Eigen::Index c = 0; c < m; ++c)
      stiffness[c] = system.scaled_levers.col(c).squaredNorm();
    double missing = 0;
    for (double softness = 1; softness < 1e10; softness *= 100)
      {
        const Eigen::VectorXd inverse = softness * stiffness.cwiseMax(1e-300).cwiseInverse();
        const Eigen::MatrixXd held = compliance + levers * inverse.asDiagonal() * levers.transpose();
        Equilibrated plain;
        plain.compliance = &held;
        plain.scale = held.diagonal().unaryExpr(
            [](const double c) { return std::exp2(std::round(-0.5 * std::log2(c))); });
        plain.lever = Eigen::VectorXd::Zero(n);
        plain.gap = plain.scale.cwiseProduct(gap - levers * inverse.cwiseProduct(moments));
        const Eigen::VectorXd overlap = (-plain.gap).cwiseMax(0);
        std::vector<int> active;
        double s = 0;
        ParametricPath path(plain);
        if (path.follow(active, plain.gap + overlap, -overlap, s, 1, {}) != ParametricPath::End::reached)
          break;
        result.pivots += path.pivots();
        std::sort(active.begin(), active.end());
        if (pivoting(active))
          return result;
        ActiveBlock block;
        if (!block.factor(plain, active))
          break;
        Eigen::VectorXd f = -plain.gap(active);
        block.solve(f);
        Eigen::VectorXd carried = Eigen::VectorXd::Zero(m);
        for (std::size_t k = 0; k < active.size(); ++k)
          carried +=
              f[static_cast<Eigen::Index>(k)] * plain.scale[active[k]] * levers.row(active[k]).transpose();
        missing = (carried - moments).norm() / std::max(moments.norm(), 1e-300);
      }
    if (missing > 1e-3) // the springs still carry it however soft they are
      result.status = Status::infeasible;
    return result;
  }
} // namespace flank
