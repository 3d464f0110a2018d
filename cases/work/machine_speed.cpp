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
    /// The least time of four, of which the first warms up; work() says whether it was done. [s]
    template <class Work>
    double seconds_of(const Work &work)
    {
      double best = 1e300;
      for (int k = 0; k < 4; ++k)
        {
          const auto start = std::chrono::steady_clock::now();
          if (work())
            best = std::min(best,
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
      return best;
    }

    double measured_operations()
    {
      const Eigen::Index n = 700;
      const Eigen::MatrixXd half = Eigen::MatrixXd::Identity(n, n) * n + Eigen::MatrixXd::Ones(n, n);
      return n * n * n / 3.0 /
             seconds_of([&] { return Eigen::LLT<Eigen::MatrixXd>(half).info() == Eigen::Success; });
    }

    double measured_logarithms()
    {
      constexpr int n = 100000;
      return n / seconds_of([] {
               double x = 1.5;
               for (int k = 0; k < n; ++k)
                 x = 1.5 + std::log(x); // each waits for the one before
               return std::isfinite(x);
             });
    }
  } // namespace

  double operations_a_second()
  {
    static const double speed = measured_operations();
    return speed;
  }

  double logarithms_a_second()
  {
    static const double speed = measured_logarithms();
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
