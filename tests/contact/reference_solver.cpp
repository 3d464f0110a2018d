// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/contact/reference_solver.hpp"

#include <cmath>
#include <limits>

namespace flank::reference
{
  namespace
  {
    using Real = long double;
    using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
    using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

    /// Forces and theta of one active set: the bordered system. Scaled to unit diagonal for the sake of
    /// extreme units.
    struct Bordered
    {
      Matrix c;
      Vector g, l, scale;
      Real torque;

      Bordered(const ContactProblem &p, const double t)
          : torque(t)
      {
        scale = p.compliance.diagonal().cast<Real>().cwiseSqrt().cwiseInverse();
        c = scale.asDiagonal() * p.compliance.cast<Real>() * scale.asDiagonal();
        g = scale.cwiseProduct(p.gap.cast<Real>());
        l = scale.cwiseProduct(p.lever.cast<Real>());
      }

      bool solve(const std::vector<int> &active, Vector &force, Real &theta) const
      {
        const auto m = static_cast<Eigen::Index>(active.size());
        Eigen::PartialPivLU<Matrix> lu(Matrix(c(active, active)));
        const Vector u = lu.solve(Vector(l(active))), v = lu.solve(Vector(g(active)));
        const Vector la = l(active);
        const Real slope = la.dot(u);
        if (m == 0 || !(std::abs(slope) > 0) || !std::isfinite(slope))
          return false;
        theta = (torque + la.dot(v)) / slope;
        force = theta * u - v;
        return true;
      }

      Answer answer(const std::vector<int> &active, const Vector &force, const Real theta) const
      {
        Answer a{ true, static_cast<double>(theta), Eigen::VectorXd::Zero(g.size()) };
        for (std::size_t k = 0; k < active.size(); ++k)
          a.force[active[k]] = static_cast<double>(force[k] * scale[active[k]]);
        return a;
      }
    };
  } // namespace

  Answer active_set(const ContactProblem &problem, const double torque)
  {
    const Bordered p(problem, torque);
    const Eigen::Index n = problem.size();
    const Real eps = std::numeric_limits<Real>::epsilon();
    std::vector<int> active(1);
    (torque > 0 ? p.l : Vector(-p.l)).maxCoeff(&active[0]);
    if (p.l[active[0]] * torque <= 0)
      return {};
    Vector current = Vector::Zero(n);
    current[active[0]] = torque / p.l[active[0]];
    for (int iteration = 0; iteration < 200 * n + 100; ++iteration)
      {
        Vector force;
        Real theta;
        if (!p.solve(active, force, theta))
          return {};
        // As far as no force turns negative.
        Real step = 1;
        int block = -1;
        for (std::size_t k = 0; k < active.size(); ++k)
          if (force[k] < 0)
            if (const Real t = current[active[k]] / (current[active[k]] - force[k]); t < step)
              {
                step = t;
                block = static_cast<int>(k);
              }
        for (std::size_t k = 0; k < active.size(); ++k)
          current[active[k]] += step * (force[k] - current[active[k]]);
        if (block >= 0)
          {
            current[active[block]] = 0;
            active.erase(active.begin() + block);
            continue;
          }
        const Vector w = p.c * current + p.g - theta * p.l;
        int enter = -1;
        Real least = 0;
        for (int i = 0; i < n; ++i)
          if (current[i] == 0 && std::find(active.begin(), active.end(), i) == active.end())
            {
              const Real limit = -4096 * eps * (std::abs(p.g[i]) + std::abs(theta * p.l[i]) + std::abs(w[i]));
              if (w[i] < limit && (w[i] < least) &&
                  (iteration < 20 * n || enter < 0)) // the least index after a long while: no cycling
                {
                  least = w[i];
                  enter = i;
                }
            }
        if (enter < 0)
          return p.answer(active, force, theta);
        active.push_back(enter);
      }
    return {};
  }

  Answer enumeration(const ContactProblem &problem, const double torque)
  {
    const Bordered p(problem, torque);
    const int n = static_cast<int>(problem.size());
    Answer best;
    Real least = 1e-12L; // relative violation that is still called a solution
    for (int set = 1; set < (1 << n); ++set)
      {
        std::vector<int> active;
        for (int i = 0; i < n; ++i)
          if (set >> i & 1)
            active.push_back(i);
        Vector force;
        Real theta;
        if (!p.solve(active, force, theta))
          continue;
        Vector all = Vector::Zero(n);
        for (std::size_t k = 0; k < active.size(); ++k)
          all[active[k]] = force[k];
        const Vector deflection = p.c * all, w = deflection + p.g - theta * p.l;
        const Real size = std::max(deflection.cwiseAbs().maxCoeff(), std::numeric_limits<Real>::min());
        const Real violation =
            std::max({ Real(0), -w.minCoeff() / size, -force.minCoeff() / all.cwiseAbs().maxCoeff() });
        if (violation < least)
          {
            least = violation;
            best = p.answer(active, force, theta);
          }
      }
    return best;
  }

  Answer projected_cg(const ContactProblem &problem, const double torque)
  {
    const Eigen::Index n = problem.size();
    const auto &c = problem.compliance;
    const auto &g = problem.gap, &l = problem.lever;
    Eigen::VectorXd f = Eigen::VectorXd::Constant(n, torque / l.sum()), t = Eigen::VectorXd::Zero(n);
    double last = 1, theta = 0;
    bool restart = true;
    for (int iteration = 0; iteration < 20000; ++iteration)
      {
        const Eigen::VectorXd u = c * f + g;
        const Eigen::ArrayXd on = (f.array() > 0).cast<double>();
        theta = (u.array() * l.array() * on).sum() / (l.array().square() * on).sum();
        Eigen::VectorXd r = u - theta * l;
        const double outside = std::max(0.0, ((1 - on) * -r.array()).maxCoeff());
        r.array() *= on;
        const double norm = r.squaredNorm();
        if (std::sqrt(norm / n) < 1e-13 * u.cwiseAbs().maxCoeff() &&
            outside < 1e-13 * u.cwiseAbs().maxCoeff())
          return { true, theta, f };
        t = ((restart ? 0 : norm / last) * t + r).array() * on;
        last = norm;
        Eigen::VectorXd ct = c * t;
        ct -= (ct.array() * l.array() * on).sum() / (l.array().square() * on).sum() * l;
        const double step =
            (ct.array() * on * t.array()).sum() == 0 ? 0 : r.dot(t) / (ct.array() * on * t.array()).sum();
        f -= step * t;
        f = f.cwiseMax(0);
        restart = false;
        for (Eigen::Index i = 0; i < n; ++i)
          if (f[i] == 0 && u[i] - theta * l[i] < 0)
            {
              f[i] -= (step > 0 ? step : 1 / c(i, i)) * (u[i] - theta * l[i]);
              restart = true;
            }
        f *= torque / f.dot(l);
      }
    return {};
  }
} // namespace flank::reference
