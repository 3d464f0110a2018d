// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/results/transmission_error_curve.hpp"

#include <functional>
#include <map>
#include <vector>

namespace flank
{
  /// Upper bounds of the errors of a measure of the transmission error over torque. [the measure's unit]
  ///
  /// At a computed torque it is what is stated there. Between two of them it is the greater one, and what the
  /// interpolation leaves: a computed torque between two others, left out, is found from those beside it; the
  /// measure of what its curve is wrong by falls at least as the distance of the torques does (so where tooth
  /// pairs take their load at once; smooth curves fall faster), towards either of them as a parabola. That is
  /// an expectation: a kink in an interval, of which nothing shows beside it, is not in it.
  class BoundsOverTorque
  {
  public:
    using Measure = std::function<double(const std::vector<double> &te)>; ///< of the period's positions

    /// `measure`: of a sum of curves no more than the sum of theirs. `stated`: bounds at the loaded torques
    /// [N m] that are computed.
    BoundsOverTorque(const TransmissionErrorCurve &curve, std::map<double, double> stated,
                     const Measure &measure);

    /// Inside the range of the loaded torques [N m]; not-a-number where nothing is stated, and between
    /// torques of which none lies between two others.
    double at(double torque) const;

  private:
    std::map<double, double> stated_;
    std::map<double, double> by_interpolation_; ///< of the interval below a torque, halfway
  };
} // namespace flank
