// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/contact_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  double Certificate::worst() const
  {
    double greatest = 0;
    for (const double value : { penetration, adhesion, complementarity, balance })
      greatest = std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : std::max(greatest, value);
    return greatest;
  }

  Certificate certify(const ContactProblem &problem, const ContactSolution &solution)
  {
    const Eigen::Index n = problem.size();
    if (solution.force.size() != n || !solution.force.allFinite() || !std::isfinite(solution.theta))
      return { std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0 };
    std::vector<Eigen::Index> loaded;
    for (Eigen::Index k = 0; k < n; ++k)
      if (solution.force[k] != 0)
        loaded.push_back(k);

    double              deflection_scale = 1e-9, load_scale = 1e-9, greatest_gap = 0, greatest_lever = 0;
    long double         moment = 0;
    std::vector<double> gap(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        long double deflection = 0;
        for (const Eigen::Index k : loaded)
          deflection +=
              static_cast<long double>(problem.compliance(k, i)) * solution.force[k]; // column of the symmetric matrix: contiguous
        const long double rigid = problem.gap[i] - static_cast<long double>(solution.theta) * problem.lever[i];
        gap[i]                  = static_cast<double>(deflection + rigid);
        deflection_scale        = std::max(deflection_scale, static_cast<double>(std::abs(deflection)));
        if (solution.force[i] != 0)
          deflection_scale = std::max(deflection_scale, static_cast<double>(std::abs(rigid)));
        load_scale     = std::max(load_scale, solution.force[i]);
        greatest_gap   = std::max(greatest_gap, std::abs(problem.gap[i]));
        greatest_lever = std::max(greatest_lever, std::abs(problem.lever[i]));
        moment += static_cast<long double>(problem.lever[i]) * solution.force[i];
      }
    load_scale = std::max(load_scale, std::abs(solution.torque) / greatest_lever);

    Certificate result;
    for (Eigen::Index i = 0; i < n; ++i)
      {
        result.penetration = std::max(result.penetration, -gap[i] / deflection_scale);
        result.adhesion    = std::max(result.adhesion, -solution.force[i] / load_scale);
        if (solution.force[i] != 0)
          result.complementarity = std::max(result.complementarity,
                                            std::abs(gap[i]) / deflection_scale * std::min(1.0, std::abs(solution.force[i]) / load_scale));
      }
    result.balance =
        static_cast<double>(std::abs(moment - solution.torque)) / std::max(std::abs(solution.torque), greatest_lever * load_scale);
    result.gate = std::max(1e-10, 100 * std::numeric_limits<double>::epsilon() * greatest_gap / deflection_scale);
    return result;
  }
} // namespace flank
