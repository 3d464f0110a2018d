// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/harmonics.hpp"

#include "mesh/base/units.hpp"

#include <complex>
#include <limits>

namespace flank
{
  namespace
  {
    /// exp(-2 pi i k / n) / n.
    std::complex<double> root(const std::size_t k, const std::size_t n)
    {
      return std::polar(1.0 / static_cast<double>(n),
                        -2 * units::pi * static_cast<double>(k) / static_cast<double>(n));
    }

    /// `root_of`: root() of the numbers below n.
    template <class RootOf>
    std::complex<double> coefficient(const std::vector<double> &values, const std::size_t i,
                                     const RootOf &root_of)
    {
      const auto n = values.size();
      std::complex<double> c = 0;
      for (std::size_t k = 0; k < n; ++k)
        c += values[k] * root_of(i * k % n);
      return c;
    }

    std::complex<double> coefficient(const std::vector<double> &values, const std::size_t i)
    {
      return coefficient(values, i, [n = values.size()](const std::size_t k) { return root(k, n); });
    }

    double weight(const std::size_t n, const std::size_t i)
    {
      return 2 * i == n ? 1 : 2;
    }
  } // namespace

  std::vector<Harmonic> harmonics(const std::vector<double> &values)
  {
    std::vector<std::complex<double>> roots;
    for (std::size_t k = 0; k < values.size(); ++k)
      roots.push_back(root(k, values.size()));
    std::vector<Harmonic> result;
    for (std::size_t i = 1; i <= values.size() / 2; ++i)
      {
        const std::complex<double> c = coefficient(values, i, [&](const std::size_t k) { return roots[k]; });
        result.push_back({ weight(values.size(), i) * std::abs(c), std::arg(c) });
      }
    return result;
  }

  std::vector<Harmonic> mesh_harmonics(const std::vector<Harmonic> &spectrum, const int cycles)
  {
    std::vector<Harmonic> result;
    for (std::size_t i = cycles; i <= spectrum.size(); i += cycles)
      result.push_back(spectrum[i - 1]);
    return result;
  }

  double harmonic_amplitude(const std::vector<double> &values, const int harmonic)
  {
    const auto i = static_cast<std::size_t>(harmonic);
    return 2 * i <= values.size() ? weight(values.size(), i) * std::abs(coefficient(values, i))
                                  : std::numeric_limits<double>::quiet_NaN();
  }

  double peak_to_peak(const std::vector<double> &values)
  {
    const auto [least, greatest] = std::ranges::minmax_element(values);
    return *greatest - *least;
  }

  double amplitude_derivative(const std::vector<double> &values, const std::vector<double> &derivatives,
                              const int harmonic)
  {
    const auto i = static_cast<std::size_t>(harmonic);
    const std::complex<double> c = coefficient(values, i);
    return std::abs(c) > 0
               ? weight(values.size(), i) * (std::conj(c) * coefficient(derivatives, i)).real() / std::abs(c)
               : 0;
  }
} // namespace flank
