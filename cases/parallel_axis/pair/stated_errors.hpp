// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/error_bounds.hpp"
#include "cases/results/design_bounds.hpp"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace flank
{
  /// Whether the greatest pressure has a limit as cells shrink, and if not, why.
  enum class PressureKind
  {
    regular,
    kink, ///< it is where a flank's slope jumps, or half of it is, which may be more on finer cells
    edge  ///< tips, cut cells and face ends carry more than the flanks inside do
  };

  /// Names of the kinds in tables, in the order of PressureKind.
  const std::vector<std::string> &pressure_kinds();

  /// Bounds of what is wrong with the results at one torque; not-a-number where there is none.
  struct ErrorsOfTorque
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    PressureKind kind = PressureKind::regular; ///< of the greatest pressure inside the flanks
    TransmissionErrorBounds te = nothing_known();
    double regular_pressure = unknown; ///< greatest away from kinks and edges; inside the flanks if that is
                                       ///< regular [MPa]
    double pressure = unknown;         ///< of that, relative
    double load_share = unknown;       ///< of a tooth pair
    std::array<double, 2> root_stress = { unknown, unknown }; ///< greatest of pinion and gear, relative

    /// Of each position's greatest pressure, where it is away from kinks and edges; empty: of none. [MPa]
    std::vector<double> pressure_at = {};

    double bound_of_pressure(const std::size_t position) const
    {
      return position < pressure_at.size() ? pressure_at[position] : unknown;
    }

    /// Of the greatest pressure over the mesh cycle, where it is regular. [MPa]
    double max_pressure() const
    {
      return kind == PressureKind::regular ? pressure * regular_pressure : unknown;
    }
  };

  /// What tables of several torques or variants have of them, a torque each.
  std::vector<DesignBounds> design_bounds(const std::vector<ErrorsOfTorque> &errors);
} // namespace flank
