// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/cycle_measures.hpp"

#include "cases/results/shown_number.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  double transmission_error_um(const GearPair &pair, const PositionResult &result)
  {
    return transmission_error(pair, result) / units::micrometre;
  }

  double transmission_error_arcsec(const GearPair &pair, const PositionResult &result)
  {
    return transmission_error(pair, result) / pair.gear.base_radius / units::arcsecond;
  }

  std::vector<double> errors_over_cycle(const GearPair &pair, const std::vector<PositionResult> &positions)
  {
    std::vector<double> values;
    for (const PositionResult &position : positions)
      values.push_back(transmission_error_um(pair, position));
    return values;
  }

  double mean_error_um(const GearPair &pair, const std::vector<PositionResult> &positions)
  {
    const std::vector<double> values = errors_over_cycle(pair, positions);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }

  std::vector<double> transmission_error_um_by_parameter(const GearPair &pair, const PositionResult &result)
  {
    std::vector<double> values;
    for (const double theta : result.theta_by_parameter)
      values.push_back(pair.pinion.base_radius / units::micrometre * theta);
    return values;
  }

  GreatestPressures greatest_pressures(const std::span<const PositionResult> positions)
  {
    GreatestPressures greatest;
    for (const PositionResult &p : positions)
      {
        greatest.inside = std::max(greatest.inside, p.max_pressure);
        greatest.at_edges = std::max(greatest.at_edges, p.edge_pressure);
      }
    return greatest;
  }

  std::vector<PositionResult> first_cycle(const ParallelAxisCase &input,
                                          const std::vector<PositionResult> &positions)
  {
    return { positions.begin(),
             positions.begin() + std::min<std::ptrdiff_t>(input.positions, positions.size()) };
  }

  StudyPoint study_point(const GearPair &pair, const PositionResult &result)
  {
    const double slope = result.stiffness > 0 ? pair.pinion.base_radius / units::micrometre *
                                                    units::newton_metre / result.stiffness
                                              : 0;
    return { .response = transmission_error_um(pair, result),
             .response_slope = slope,
             .max_pressure = result.max_pressure,
             .edge_pressure = result.edge_pressure,
             .stiffness = tangent_stiffness(pair, result) / units::newton_per_micrometre,
             .certificate = result.certificate.worst(),
             .contacts = static_cast<int>(result.pairs.size()) };
  }

  VariantFrame frame_of(const ParallelAxisCase &input)
  {
    VariantFrame frame;
    for (const double torque : input.torques)
      frame.loads.push_back(torque / units::newton_metre);
    for (int k = 0; k < input.positions * input.cycles; ++k)
      frame.abscissa.push_back(static_cast<double>(k) / input.positions);
    frame.period = input.positions * input.cycles;
    frame.order = input.cycles;
    return frame;
  }

  std::vector<StudyPoint> study_points(const ParallelAxisCase &input, const ParallelAxisResults &results)
  {
    std::vector<StudyPoint> points;
    for (std::size_t k = 0; k < results.at.front().size(); ++k)
      for (const auto &positions : results.at)
        points.push_back(study_point(input.pair, positions[k]));
    return points;
  }

  std::string shown_torque(const double torque)
  {
    return shown_number(torque / units::newton_metre, 3);
  }

  std::string shown_pressure(const std::vector<PositionResult> &positions)
  {
    const auto [inside, at_edges] = greatest_pressures(positions);
    return inside > 0 || at_edges == 0 ? shown_number(inside, 1) : "at edges";
  }

  double noise_of_harmonics(const std::vector<double> &te)
  {
    const auto [least, greatest] = std::minmax_element(te.begin(), te.end());
    const double mean = std::accumulate(te.begin(), te.end(), 0.0) / static_cast<double>(te.size());
    return 1e-4 * (*greatest - *least) + 1e-5 * std::abs(mean);
  }
} // namespace flank
