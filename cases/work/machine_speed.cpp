// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/machine_speed.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace flank
{
  namespace
  {
    double measured_speed()
    {
      const Eigen::Index n = 700;
      const Eigen::MatrixXd half = Eigen::MatrixXd::Identity(n, n) * n + Eigen::MatrixXd::Ones(n, n);
      double best = 1e300;
      for (int k = 0; k < 4; ++k) // the first one warms up
        {
          const auto start = std::chrono::steady_clock::now();
          const Eigen::LLT<Eigen::MatrixXd> factor(half);
          if (factor.info() == Eigen::Success)
            best = std::min(best,
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
      return n * n * n / 3.0 / best;
    }
  } // namespace

  double operations_a_second()
  {
    static const double speed = measured_speed();
    return speed;
  }

  std::string two_digits(const double value)
  {
    if (!(value >= 99.5) || std::isinf(value))
      return fmt::format("{:.2g}", value);
    const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
    return fmt::format("{:.0f}", std::round(value / unit) * unit);
  }
} // namespace flank
