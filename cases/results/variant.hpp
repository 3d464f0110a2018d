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
} // namespace flank
