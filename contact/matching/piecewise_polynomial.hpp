// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <vector>

namespace flank
{
  /// Interpolates a function of one variable by a polynomial on each of some intervals, through Chebyshev
  /// points.
  class PiecewisePolynomial
  {
  public:
    static constexpr int max_points = 8;

    PiecewisePolynomial() = default;
    PiecewisePolynomial(std::vector<double> breaks, int points);

    int size() const { return (static_cast<int>(breaks.size()) - 1) * points; }
    double abscissa(int i) const;
    double low() const { return breaks.front(); }
    double high() const { return breaks.back(); }

    /// Value at x (clamped to the range) = sum of weight[k] times the value at abscissa first + k, k <
    /// points. Where two intervals meet the upper one counts, however x is rounded.
    void weights(double x, int &first, std::array<double, max_points> &weight) const;

    std::vector<double> breaks;
    int points = 0;
  };
} // namespace flank
