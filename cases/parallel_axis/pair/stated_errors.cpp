// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/stated_errors.hpp"

namespace flank
{
  const std::vector<std::string> &pressure_kinds()
  {
    static const std::vector<std::string> names = { "regular", "kink", "edge" };
    return names;
  }

  std::vector<DesignBounds> design_bounds(const std::vector<ErrorsOfTorque> &errors)
  {
    std::vector<DesignBounds> bounds;
    for (const ErrorsOfTorque &of : errors)
      bounds.push_back({ .mean = of.te.mean,
                         .peak_to_peak = of.te.peak_to_peak,
                         .amplitude = of.te.amplitude,
                         .max_pressure = of.max_pressure(),
                         .pressure_kind = pressure_kinds()[static_cast<std::size_t>(of.kind)] });
    return bounds;
  }
} // namespace flank
