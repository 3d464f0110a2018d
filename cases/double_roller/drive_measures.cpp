// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/results.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  Peaks peaks(const DrivePosition &position)
  {
    Peaks p;
    for (const RollerPairLoad &load : position.pairs)
      {
        p.mid = std::max(p.mid, load.mid_pressure);
        p.edge = std::max(p.edge, load.edge_pressure);
        p.force = std::max(p.force, load.force);
      }
    return p;
  }

  double micrometres(const DoubleRollerCase &input, const double rotation)
  {
    return rotation * input.drive.sleeve_circle_radius / units::micrometre;
  }

  std::vector<double> lags_um(const DoubleRollerCase &input, const std::vector<DrivePosition> &positions,
                              const std::size_t count)
  {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i)
      values.push_back(micrometres(input, positions[i].lag));
    return values;
  }

  double secant_stiffness(const DoubleRollerCase &input, const DoubleRollerResults &results,
                          const std::size_t t, const std::size_t k)
  {
    const double wound = results.unloaded_psi[k] - results.at[t][k].psi;
    return input.model.input_torque || wound <= 0 ? 0 : input.torques[t] / wound;
  }

  DriveMeans means(const DoubleRollerCase &input, const DoubleRollerResults &results, const std::size_t t)
  {
    const VariantFrame frame = frame_of(input);
    const std::vector<DrivePosition> &at = results.at[t];
    return { .lag = mean_over_period(frame, [&](const std::size_t k) { return at[k].lag; }),
             .tangent = mean_over_period(frame, [&](const std::size_t k) { return at[k].stiffness; }),
             .secant = mean_over_period(
                 frame, [&](const std::size_t k) { return secant_stiffness(input, results, t, k); }) };
  }

  double gear_ratio(const DoubleRollerCase &input, const DoubleRollerResults &results, const std::size_t t,
                    const std::size_t k)
  {
    return input.model.secant_ratio ? results.secant_gear_ratio[t][k] : results.at[t][k].gear_ratio;
  }

  std::size_t period_positions(const DoubleRollerCase &input)
  {
    if (input.crank_angles.size() < 2)
      return 0;
    const double exact = period_of_crank(input.drive) / (input.crank_angles[1] - input.crank_angles[0]);
    const auto count = static_cast<std::size_t>(std::lround(exact));
    return std::abs(exact - static_cast<double>(count)) < 1e-6 * exact && count >= 2 &&
                   count <= input.crank_angles.size()
               ? count
               : 0;
  }

  StudyPoint study_point(const DoubleRollerCase &input, const DrivePosition &position)
  {
    const double radius = input.drive.sleeve_circle_radius;
    const Peaks peak = peaks(position);
    return { .response = micrometres(input, position.lag),
             .response_slope = position.torque_by_lag > 0
                                   ? micrometres(input, units::newton_metre / position.torque_by_lag)
                                   : 0,
             .max_pressure = peak.mid,
             .edge_pressure = peak.edge,
             .stiffness = position.stiffness / (radius * radius) / units::newton_per_micrometre,
             .certificate = std::max(position.balance, position.certificate),
             .contacts = static_cast<int>(position.pairs.size()) };
  }

  VariantFrame frame_of(const DoubleRollerCase &input)
  {
    VariantFrame frame;
    for (const double torque : input.torques)
      frame.loads.push_back(torque / units::newton_metre);
    for (const double angle : input.crank_angles)
      frame.abscissa.push_back(angle / units::degree);
    frame.period = static_cast<int>(period_positions(input));
    frame.order = frame.period > 0 ? pitches_in_period(input.drive) : 1;
    return frame;
  }

  std::vector<StudyPoint> study_points(const DoubleRollerCase &input, const DoubleRollerResults &results)
  {
    std::vector<StudyPoint> points;
    for (std::size_t k = 0; k < results.at.front().size(); ++k)
      for (const auto &positions : results.at)
        points.push_back(study_point(input, positions[k]));
    return points;
  }
} // namespace flank
