// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/transmission_error_curve.hpp"

#include "cases/results/harmonics.hpp"
#include "mesh/base/least.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  TransmissionErrorCurve::TransmissionErrorCurve(const VariantFrame &frame,
                                                 const std::vector<StudyPoint> &points)
      : frame_(frame)
      , points_(points)
      , order_(frame.loads.size())
  {
    const auto &t = frame.loads;
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](const int a, const int b) { return t[a] < t[b]; });
    order_.erase(
        std::unique(order_.begin(), order_.end(), [&](const int a, const int b) { return t[a] == t[b]; }),
        order_.end());
  }

  std::vector<double> TransmissionErrorCurve::torques() const
  {
    std::vector<double> torques;
    for (const int k : order_)
      torques.push_back(frame_.loads[k]);
    return torques;
  }

  std::vector<double> TransmissionErrorCurve::loaded_torques() const
  {
    std::vector<double> loaded = torques();
    std::erase_if(loaded, [](const double torque) { return !(torque > 0); });
    return loaded;
  }

  TransmissionErrorCurve TransmissionErrorCurve::without(const double torque) const
  {
    TransmissionErrorCurve others = *this;
    std::erase_if(others.order_, [&](const int k) { return frame_.loads[k] == torque; });
    return others;
  }

  TransmissionErrorCurve::Values TransmissionErrorCurve::values(const double torque) const
  {
    const auto &t = frame_.loads;
    const std::size_t n = averaged_positions(frame_);
    const std::size_t above =
        std::clamp<std::size_t>(std::upper_bound(order_.begin(), order_.end(), torque,
                                                 [&](const double x, const int k) { return x < t[k]; }) -
                                    order_.begin(),
                                1, std::max<std::size_t>(1, order_.size() - 1));
    const int a = order_[above - 1], b = order_[std::min(above, order_.size() - 1)];
    const double width = t[b] - t[a], s = width > 0 ? (torque - t[a]) / width : 0;
    Values result{ std::vector<double>(n), std::vector<double>(n) };
    for (std::size_t k = 0; k < n; ++k)
      {
        const StudyPoint &low = points_[k * t.size() + a], &high = points_[k * t.size() + b];
        const double rise = high.response - low.response;
        // A slope that is not known: the parabola with the other one, or the chord.
        const bool low_known = low.response_slope != 0, high_known = high.response_slope != 0;
        const double at_high = high_known  ? high.response_slope * width
                               : low_known ? 2 * rise - low.response_slope * width
                                           : rise,
                     at_low = low_known ? low.response_slope * width : 2 * rise - at_high;
        const double second = 3 * rise - 2 * at_low - at_high, third = at_low + at_high - 2 * rise;
        result.te[k] = low.response + s * (at_low + s * (second + s * third));
        result.slope[k] = width > 0 ? (at_low + s * (2 * second + s * 3 * third)) / width : 0;
      }
    return result;
  }

  std::vector<double> TransmissionErrorCurve::te(const double torque) const
  {
    return values(torque).te;
  }

  double TransmissionErrorCurve::amplitude(const double torque, const int harmonic) const
  {
    return harmonic_amplitude(te(torque), harmonic * frame_.order);
  }

  double TransmissionErrorCurve::peak_to_peak(const double torque) const
  {
    return flank::peak_to_peak(te(torque));
  }

  std::vector<DesignTorque> TransmissionErrorCurve::torques_of_least_amplitude() const
  {
    const auto slope = [&](const double torque) {
      const Values at = values(torque);
      return amplitude_derivative(at.te, at.slope, frame_.order);
    };
    return minima([&](const double torque) { return amplitude(torque, 1); }, slope);
  }

  std::vector<DesignTorque> TransmissionErrorCurve::torques_of_least_peak_to_peak() const
  {
    const auto slope = [&](const double torque) {
      const Values at = values(torque);
      const auto [low, high] = std::minmax_element(at.te.begin(), at.te.end());
      return at.slope[high - at.te.begin()] - at.slope[low - at.te.begin()];
    };
    return minima([&](const double torque) { return peak_to_peak(torque); }, slope);
  }

  double TransmissionErrorCurve::greatest_response() const
  {
    double greatest = 0;
    for (const StudyPoint &point : points_)
      greatest = std::max(greatest, std::abs(point.response));
    return greatest;
  }

  std::vector<DesignTorque> TransmissionErrorCurve::minima(const Function &quantity,
                                                           const Function &slope) const
  {
    constexpr int parts = 12; // of an interval between two computed torques
    std::vector<double> torque, value;
    for (std::size_t k = 0; k + 1 < order_.size(); ++k)
      for (int part = 0; part < parts + (k + 2 == order_.size()); ++part)
        {
          const double low = frame_.loads[order_[k]], high = frame_.loads[order_[k + 1]];
          torque.push_back(low + (high - low) * part / parts);
          value.push_back(quantity(torque.back()));
        }
    const double rounding = 1e-12 * greatest_response();
    std::vector<DesignTorque> found;
    for (std::size_t first = 0, last = 0; first < torque.size(); first = last + 1)
      {
        const double same = std::max(1e-9 * value[first], rounding); // height, but for rounding
        last = first;
        while (last + 1 < torque.size() && std::abs(value[last + 1] - value[first]) <= same)
          ++last;
        if (first == 0 || last + 1 == torque.size() || !(value[first - 1] > value[first]) ||
            !(value[last + 1] > value[last]))
          continue;
        const auto [at, least] = least_where_flat(quantity, slope, torque[first - 1], torque[last + 1], 24);
        // Several of them are a plateau, unless a valley lies between two.
        if (last == first || least < *std::min_element(&value[first], &value[last] + 1) - same)
          found.push_back({ at, least });
      }
    return found;
  }
} // namespace flank
