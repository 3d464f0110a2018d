// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/harmonics.hpp"

#include "mesh/base/units.hpp"

#include <complex>

namespace flank
{
  std::vector<Harmonic> harmonics(const std::vector<double> &values)
  {
    const auto            n = values.size();
    std::vector<Harmonic> result;
    for (std::size_t i = 1; i <= n / 2; ++i)
      {
        std::complex<double> c = 0;
        for (std::size_t k = 0; k < n; ++k)
          c += values[k] * std::polar(1.0 / n, -2 * units::pi * static_cast<double>(i * k % n) / n);
        result.push_back({ (2 * i == n ? 1 : 2) * std::abs(c), std::arg(c) });
      }
    return result;
  }
} // namespace flank
