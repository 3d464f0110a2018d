// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <vector>

namespace flank
{
  /// What a study keeps of one position at one load.
  struct StudyPoint
  {
    double response;       ///< transmission error, or approach of rollers [um]
    double response_slope; ///< d response / d load [um over the load's unit]; 0: not known (unloaded)
    double max_pressure, edge_pressure; ///< [MPa]
    double stiffness;                   ///< tangent, [N/um]
    double certificate;                 ///< worst relative violation
    int contacts;                       ///< loaded pairs
  };

  /// Over which loads and positions a variant is computed.
  struct VariantFrame
  {
    std::vector<double> loads;    ///< torques [N m], or forces [N]
    std::vector<double> abscissa; ///< of the positions, in the unit of StudyColumns
    int period = 0; ///< first positions that make whole periods; 0: none, there are no harmonics
    int order = 1;  ///< number of the mesh frequency's line in the spectrum over these positions

    std::vector<std::string> parameters = {}; ///< keys by which the response is differentiated

    bool operator==(const VariantFrame &) const = default;
  };

  /// Positions over which every mean is taken: the whole periods, of which no position counts twice; all of
  /// them where they hold no period.
  inline std::size_t averaged_positions(const VariantFrame &frame)
  {
    return frame.period > 0 ? static_cast<std::size_t>(frame.period) : frame.abscissa.size();
  }

  /// Mean of value(position) over these positions, in the unit of the values.
  template <class Value>
  double mean_over_period(const VariantFrame &frame, const Value &value)
  {
    const std::size_t count = averaged_positions(frame);
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k)
      sum += value(k);
    return sum / static_cast<double>(count);
  }
} // namespace flank
