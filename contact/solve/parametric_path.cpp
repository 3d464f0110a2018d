// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/parametric_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  ParametricPath::ParametricPath(const Equilibrated &problem)
      : problem_(problem)
  {
  }

  bool ParametricPath::rebuild(const std::vector<int> &active)
  {
    if (!block_.factor(problem_, active))
      return false;
    const auto m = static_cast<Eigen::Index>(active.size());
    if (inverse_.rows() < m + 1)
      inverse_ = Eigen::MatrixXd(2 * m + 16, 2 * m + 16); // whole where memory fails, unlike resize()
    block_.invert(inverse_.topLeftCorner(m, m));
    return true;
  }

  /// Bordered inverse; `active` without the cell.
  bool ParametricPath::append(const std::vector<int> &active, const int cell)
  {
    const auto m = static_cast<Eigen::Index>(active.size());
    if (inverse_.rows() < m + 1)
      inverse_.conservativeResize(2 * m + 16, 2 * m + 16);
    Eigen::VectorXd column(m), row(m);
    for (Eigen::Index i = 0; i < m; ++i)
      {
        column[i] = problem_.entry(active[i], cell);
        row[i] = problem_.entry(cell, active[i]);
      }
    const Eigen::VectorXd z = inverse_.topLeftCorner(m, m) * column,
                          x = inverse_.topLeftCorner(m, m).transpose() * row;
    const double diagonal = problem_.entry(cell, cell), pivot = diagonal - row.dot(z);
    if (!(pivot > 1e-14 * diagonal))
      return false;
    inverse_.topLeftCorner(m, m).noalias() += z * (x / pivot).transpose();
    inverse_.col(m).head(m) = -z / pivot;
    inverse_.row(m).head(m) = -x.transpose() / pivot;
    inverse_(m, m) = 1 / pivot;
    return true;
  }

  void ParametricPath::remove(const Eigen::Index k, const Eigen::Index m)
  {
    const Eigen::VectorXd column = inverse_.col(k).head(m), row = inverse_.row(k).head(m) / inverse_(k, k);
    inverse_.topLeftCorner(m, m).noalias() -= column * row.transpose();
    for (Eigen::Index i = k; i + 1 < m; ++i)
      inverse_.col(i).head(m) = inverse_.col(i + 1).head(m);
    for (Eigen::Index i = k; i + 1 < m; ++i)
      inverse_.row(i).head(m - 1) = inverse_.row(i + 1).head(m - 1);
  }

  /// One corner a turn: forces and gaps with their rates, the nearest corner, the pivot. They share all their
  /// vectors, so that it reads best in one piece.
  ParametricPath::End ParametricPath::follow(std::vector<int> &active, const Eigen::VectorXd &q0,
                                             const Eigen::VectorXd &d, double &s, const double s_end,
                                             const std::optional<double> torque,
                                             std::vector<Breakpoint> *record)
  {
    const Eigen::Index n = problem_.size();
    const int bound = 50 * static_cast<int>(n) + 1000;
    const auto &l = problem_.lever;
    std::vector<char> is_active(n, 0);
    for (const int i : active)
      is_active[i] = 1;
    if (!rebuild(active))
      return End::lost;
    // What updates lose is made good now and then; on a block that was singular, at every corner.
    const int rebuild_after = problem_.regularisation > 0 ? 1 : 64;
    int since_rebuild = 0;
    // Which way: towards s_end, and with a torque to reach, towards it (T grows with theta).
    double sense = s_end >= s ? 1 : -1;
    for (int steps = 0; steps <= bound; ++steps)
      {
        if (since_rebuild >= rebuild_after)
          {
            if (!rebuild(active))
              return End::lost;
            since_rebuild = 0;
          }
        const auto m = static_cast<Eigen::Index>(active.size());
        const auto b = inverse_.topLeftCorner(m, m);
        const Eigen::VectorXd force = -(b * (q0(active) + s * d(active))), rate = -sense * (b * d(active));
        Eigen::VectorXd w = q0 + s * d, w_rate = sense * d, deflection = Eigen::VectorXd::Zero(n),
                        deflection_rate = deflection;
        problem_.add_deflection(active, force, deflection);
        problem_.add_deflection(active, rate, deflection_rate);

        const double moment = l(active).dot(force), moment_rate = l(active).dot(rate);
        double step = sense * (s_end - s);
        bool target = std::isfinite(step);
        if (torque)
          if (const double missing = *torque - moment; missing * moment_rate > 0 || missing == 0)
            if (const double way = missing == 0 ? 0 : missing / moment_rate; way <= step)
              {
                step = way;
                target = true;
              }
        int chosen = -1;
        const auto consider = [&](const double value, const double size, const double slope, const int cell) {
          const double t = value <= 1e-13 * size ? 0 : value / -slope;
          if (t < step * (1 - 1e-13) || (t <= step * (1 + 1e-13) && chosen >= 0 && cell < chosen))
            {
              step = std::min(step, t);
              chosen = cell;
            }
        };
        const double force_size = m > 0 ? force.cwiseAbs().maxCoeff() : 0,
                     rate_size = m > 0 ? rate.cwiseAbs().maxCoeff() : 0;
        for (Eigen::Index k = 0; k < m; ++k)
          if (rate[k] < -1e-12 * rate_size)
            consider(force[k], force_size, rate[k], active[k]);
        for (Eigen::Index j = 0; j < n; ++j)
          if (!is_active[j])
            {
              const double slope = deflection_rate[j] + w_rate[j];
              if (slope < -1e-12 * (std::abs(deflection_rate[j]) + std::abs(w_rate[j])))
                consider(deflection[j] + w[j], std::abs(deflection[j]) + std::abs(w[j]), slope,
                         static_cast<int>(j));
            }
        if (chosen < 0)
          {
            if (!target)
              return End::unbounded;
            s += sense * step;
            return End::reached;
          }
        s += sense * step;
        if (record)
          record->push_back({ moment + step * moment_rate, s, sense * moment_rate, chosen });
        if (is_active[chosen])
          {
            const auto place = std::find(active.begin(), active.end(), chosen);
            remove(place - active.begin(), m);
            active.erase(place);
          }
        else
          {
            if (!append(active, chosen))
              return End::lost;
            active.push_back(chosen);
          }
        is_active[chosen] ^= 1;
        ++pivots_;
        ++since_rebuild;
      }
    return End::lost;
  }
} // namespace flank
