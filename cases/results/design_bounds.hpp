// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <limits>
#include <string>

namespace flank
{
  /// Upper bounds of the errors of a variant at a load; not-a-number where there is none.
  struct DesignBounds
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double mean = unknown, peak_to_peak = unknown;                   ///< [um]
    std::array<double, 3> amplitude = { unknown, unknown, unknown }; ///< of A1 to A3 [um]
    double max_pressure = unknown;                                   ///< [MPa]
    std::string pressure_kind = {}; ///< of the greatest pressure: where it has a limit; empty: not known
  };
} // namespace flank
