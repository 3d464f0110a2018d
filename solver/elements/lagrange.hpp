// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <vector>

namespace flank
{
  /// Lagrange polynomials through two to four points of an axis.
  class LagrangePolynomials
  {
  public:
    static constexpr int max_points = 4;
    using Values = std::array<double, max_points>; ///< of each polynomial; 0 beyond size()

    explicit LagrangePolynomials(const std::vector<double> &abscissas)
        : size_(static_cast<int>(abscissas.size()))
    {
      for (int i = 0; i < size_; ++i)
        {
          abscissa_[i] = abscissas[i];
          for (int j = 0; j < size_; ++j)
            inverse_[i][j] = i == j ? 0 : 1 / (abscissas[i] - abscissas[j]);
        }
    }

    int size() const { return size_; }

    Values values(const double t) const
    {
      Values result{};
      for (int i = 0; i < size_; ++i)
        {
          result[i] = 1;
          for (int j = 0; j < size_; ++j)
            if (j != i)
              result[i] *= (t - abscissa_[j]) * inverse_[i][j];
        }
      return result;
    }

    struct WithDerivatives
    {
      Values value{}, derivative{};
    };
    WithDerivatives with_derivatives(const double t) const
    {
      WithDerivatives result;
      for (int i = 0; i < size_; ++i)
        {
          double v = 1, d = 0;
          for (int j = 0; j < size_; ++j)
            if (j != i)
              {
                const double scale = inverse_[i][j];
                d = d * (t - abscissa_[j]) * scale + v * scale;
                v *= (t - abscissa_[j]) * scale;
              }
          result.value[i] = v;
          result.derivative[i] = d;
        }
      return result;
    }

  private:
    int size_;
    Values abscissa_{};
    std::array<Values, max_points> inverse_{}; ///< 1 / (abscissa i - abscissa j)
  };
} // namespace flank
