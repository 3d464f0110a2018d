// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/piecewise_polynomial.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  PiecewisePolynomial::PiecewisePolynomial(std::vector<double> breaks, const int points)
      : breaks(std::move(breaks))
      , points(points)
  {
    FLANK_ASSERT(this->breaks.size() >= 2 && points >= 2 && points <= max_points, "intervals with points");
  }

  namespace
  {
    /// Chebyshev points of [-1, 1] in ascending order, and the weights of the barycentric formula: [number of
    /// points][k].
    struct ChebyshevPoints
    {
      ChebyshevPoints()
      {
        for (int n = 2; n <= PiecewisePolynomial::max_points; ++n)
          {
            for (int k = 0; k < n; ++k)
              at[n][k] = -std::cos(units::pi * (k + 0.5) / n);
            for (int k = 0; k < n; ++k)
              {
                inverse[n][k] = 1;
                for (int j = 0; j < n; ++j)
                  if (j != k)
                    inverse[n][k] /= at[n][k] - at[n][j];
              }
          }
      }
      double at[PiecewisePolynomial::max_points + 1][PiecewisePolynomial::max_points];
      double inverse[PiecewisePolynomial::max_points + 1]
                    [PiecewisePolynomial::max_points]; ///< 1 / product of (at[k] - at[j]), j != k
    };
    const ChebyshevPoints chebyshev;
  } // namespace

  double PiecewisePolynomial::abscissa(const int i) const
  {
    const int interval = i / points, k = i % points;
    const double low = breaks[interval], high = breaks[interval + 1];
    return 0.5 * (low + high) + 0.5 * (high - low) * chebyshev.at[points][k];
  }

  void PiecewisePolynomial::weights(double x, int &first, std::array<double, max_points> &weight) const
  {
    // The polynomials of two intervals differ where they meet: what rounding alone keeps from there, as
    // points of slices that share borders with the elements, is of the upper one.
    constexpr double rounding = 1e-9;
    x = std::clamp(x, breaks.front(), breaks.back());
    const auto above = std::upper_bound(breaks.begin(), breaks.end(), x + rounding);
    const int interval =
        std::clamp(static_cast<int>(above - breaks.begin()) - 1, 0, static_cast<int>(breaks.size()) - 2);
    first = interval * points;
    const double low = breaks[interval], high = breaks[interval + 1], t = (2 * x - low - high) / (high - low);
    for (int k = 0; k < points; ++k)
      {
        weight[k] = chebyshev.inverse[points][k];
        for (int j = 0; j < points; ++j)
          if (j != k)
            weight[k] *= t - chebyshev.at[points][j];
      }
  }
} // namespace flank
