// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    /// Compliance times forces. Every product and sum is split into its rounded value and its rounding error
    /// (Dekker 1971; Ogita, Rump and Oishi 2005), which are summed apart: as in twice the working precision,
    /// at the speed of vectors.
    std::vector<long double> product(const Eigen::MatrixXd &compliance, const Eigen::VectorXd &force)
    {
      const Eigen::Index n = force.size();
      std::vector<double> sum(n, 0.0), error(n, 0.0);
      for (Eigen::Index k = 0; k < n; ++k)
        if (const double f = force[k]; f != 0)
          {
            const double *column = compliance.data() + k * compliance.outerStride();
            for (Eigen::Index i = 0; i < n; ++i)
              {
                const double term = column[i] * f, lost_in_term = std::fma(column[i], f, -term);
                const double total = sum[i] + term, part = total - sum[i];
                error[i] += (sum[i] - (total - part)) + (term - part) + lost_in_term;
                sum[i] = total;
              }
          }
      std::vector<long double> result(n);
      for (Eigen::Index i = 0; i < n; ++i)
        result[i] = static_cast<long double>(sum[i]) + error[i];
      return result;
    }

    /// Holds in no way.
    Certificate no_solution()
    {
      Certificate none;
      none.penetration = std::numeric_limits<double>::quiet_NaN();
      return none;
    }
  } // namespace

  double Certificate::worst() const
  {
    double greatest = 0;
    for (const double value : { penetration, adhesion, complementarity, balance })
      greatest = std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : std::max(greatest, value);
    return greatest;
  }

  Certificate certify(const Eigen::MatrixXd &compliance, const Eigen::VectorXd &gap,
                      const Eigen::MatrixXd &levers, const Eigen::VectorXd &moments,
                      const Eigen::VectorXd &theta, const Eigen::VectorXd &force)
  {
    const Eigen::Index n = gap.size(), m = levers.cols();
    if (force.size() != n || theta.size() != m || !force.allFinite() || !theta.allFinite())
      return no_solution();

    const std::vector<long double> deflection = product(compliance, force);
    std::vector<long double> moment(m, 0.0L);
    for (Eigen::Index k = 0; k < n; ++k)
      if (force[k] != 0)
        for (Eigen::Index c = 0; c < m; ++c)
          moment[c] += static_cast<long double>(levers(k, c)) * force[k];
    double deflection_scale = 1e-9, load_scale = 1e-9;
    std::vector<double> separation(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        long double rigid = gap[i];
        for (Eigen::Index c = 0; c < m; ++c)
          rigid -= static_cast<long double>(theta[c]) * levers(i, c);
        separation[i] = static_cast<double>(deflection[i] + rigid);
        if (!std::isfinite(separation[i]))
          return no_solution();
        deflection_scale = std::max(deflection_scale, static_cast<double>(std::abs(deflection[i])));
        if (force[i] != 0)
          deflection_scale = std::max(deflection_scale, static_cast<double>(std::abs(rigid)));
        load_scale = std::max(load_scale, force[i]);
      }
    for (Eigen::Index c = 0; c < m; ++c)
      if (const double greatest_lever = levers.col(c).cwiseAbs().maxCoeff(); greatest_lever > 0)
        load_scale = std::max(load_scale, std::abs(moments[c]) / greatest_lever);

    Certificate result;
    for (Eigen::Index i = 0; i < n; ++i)
      {
        result.penetration = std::max(result.penetration, -separation[i] / deflection_scale);
        result.adhesion = std::max(result.adhesion, -force[i] / load_scale);
        if (force[i] != 0)
          result.complementarity =
              std::max(result.complementarity, std::abs(separation[i]) / deflection_scale);
      }
    for (Eigen::Index c = 0; c < m; ++c)
      {
        const double scale = std::max(std::abs(moments[c]), levers.col(c).cwiseAbs().maxCoeff() * load_scale);
        if (scale > 0)
          result.balance =
              std::max(result.balance, static_cast<double>(std::abs(moment[c] - moments[c])) / scale);
      }
    result.gate = std::max(1e-10, 100 * std::numeric_limits<double>::epsilon() * gap.cwiseAbs().maxCoeff() /
                                      deflection_scale);
    return result;
  }

  Certificate certify(const ContactProblem &problem, const ContactSolution &solution)
  {
    if (solution.status != Status::solved)
      return no_solution();
    return certify(problem.compliance, problem.gap, problem.lever,
                   Eigen::VectorXd::Constant(1, solution.torque),
                   Eigen::VectorXd::Constant(1, solution.theta), solution.force);
  }
} // namespace flank
