// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"

namespace flank
{
  /// The report of `flank check`: derived geometry, modifications, mesh, ISO 6336 stiffness, warnings.
  std::string geometry_report(const ParallelAxisCase &input);
} // namespace flank
