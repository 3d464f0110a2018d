// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/results/variant.hpp"

#include <functional>

namespace flank
{
  struct DesignTorque
  {
    double torque; ///< [N m]
    double value;  ///< of A1 or peak-to-peak, which is least there [um]
  };

  /// Transmission error of one variant over torque, between the computed torques too: at every position the
  /// cubic through both values and both exact slopes.
  class TransmissionErrorCurve
  {
  public:
    /// points[position * torques + torque].
    TransmissionErrorCurve(const VariantFrame &frame, const std::vector<StudyPoint> &points);

    std::vector<double> torques() const;        ///< computed ones, ascending, each once [N m]
    std::vector<double> loaded_torques() const; ///< likewise, without 0

    /// The same but for one computed torque [N m], as if it were not known. Refers to the same points.
    TransmissionErrorCurve without(double torque) const;

    std::vector<double> te(double torque) const; ///< at the positions of the period [um]

    /// Peak amplitude A_i of a mesh harmonic. [um]
    double amplitude(double torque, int harmonic) const;
    double peak_to_peak(double torque) const;

    /// All local minima inside the range of torques, of the peak amplitude A_1 and of peak-to-peak. A minimum
    /// lies below both sides by more than 1e-9 of its value: a range of torques over which the value stays
    /// the same is none.
    std::vector<DesignTorque> torques_of_least_amplitude() const;
    std::vector<DesignTorque> torques_of_least_peak_to_peak() const;

  private:
    /// Values [um] and slopes over torque [um/(N m)] at the positions of the period.
    struct Values
    {
      std::vector<double> te, slope;
    };
    Values values(double torque) const;

    using Function = std::function<double(double)>; ///< of the torque
    double greatest_response() const;               ///< [um]
    std::vector<DesignTorque> minima(const Function &quantity, const Function &slope) const;

    const VariantFrame &frame_;
    const std::vector<StudyPoint> &points_;
    std::vector<int> order_; ///< of the torques, ascending, each once
  };
} // namespace flank
