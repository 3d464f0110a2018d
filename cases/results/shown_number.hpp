// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace flank
{
  /// A number as a table on the screen has it: with so many decimals, or with three digits where it is so
  /// small that these would not show two of them. 0 is exactly that.
  inline std::string shown_number(const double value, const int decimals)
  {
    return value == 0 || std::abs(value) >= std::pow(10.0, 1 - decimals)
               ? fmt::format("{:.{}f}", value, decimals)
               : fmt::format("{:.3g}", value);
  }
} // namespace flank
