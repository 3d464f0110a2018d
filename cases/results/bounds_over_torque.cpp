// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/bounds_over_torque.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flank
{
  namespace
  {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    /// Of what curves without a torque are wrong by: a kink in the narrower interval may leave somewhat more.
    constexpr double of_missed = 1.25;

    /// How an interpolation's error goes over an interval: 1 halfway, 0 at its ends.
    double parabola(const double low, const double at, const double high)
    {
      const double s = (at - low) / (high - low);
      return 4 * s * (1 - s);
    }

    /// The measure of what is wrong, halfway between the torques beside torque `k`, when it is left out, over
    /// their distance. [the measure's unit over N m]
    double missed_by_distance(const TransmissionErrorCurve &curve, const std::vector<double> &torques,
                              const std::size_t k, const BoundsOverTorque::Measure &measure)
    {
      const double low = torques[k - 1], at = torques[k], high = torques[k + 1];
      std::vector<double> wrong = curve.without(at).te(at);
      const std::vector<double> te = curve.te(at);
      for (std::size_t i = 0; i < te.size(); ++i)
        wrong[i] -= te[i];
      return measure(wrong) / std::pow(parabola(low, at, high), 2) / (high - low);
    }
  } // namespace

  BoundsOverTorque::BoundsOverTorque(const TransmissionErrorCurve &curve, std::map<double, double> stated,
                                     const Measure &measure)
      : stated_(std::move(stated))
  {
    const std::vector<double> torques = curve.torques();
    std::vector<double> missed(torques.size(), unknown); // over the distance of those beside each
    for (std::size_t k = 1; k + 1 < torques.size(); ++k)
      missed[k] = missed_by_distance(curve, torques, k, measure);
    for (std::size_t above = 1; above < torques.size(); ++above)
      by_interpolation_[torques[above]] =
          of_missed * std::fmax(missed[above - 1], missed[above]) * (torques[above] - torques[above - 1]);
  }

  double BoundsOverTorque::at(const double torque) const
  {
    if (const auto computed = stated_.find(torque); computed != stated_.end())
      return computed->second;
    const auto above = stated_.upper_bound(torque);
    if (above == stated_.begin() || above == stated_.end())
      return unknown;
    const auto &[low, of_low] = *std::prev(above);
    const auto &[high, of_high] = *above;
    const double greater = std::isnan(of_low) ? of_low : std::max(of_high, of_low);
    return greater + by_interpolation_.at(high) * parabola(low, torque, high);
  }
} // namespace flank
