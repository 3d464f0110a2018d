// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/roller_pair/input.hpp"

namespace flank
{
  /// Additions and multiplications of all contacts of a case: of the Cholesky factors of their grids, of
  /// which three are tried.
  double operations(const RollerPairCase &input);

  /// Memory of a process. [bytes]
  double bytes_needed(const RollerPairCase &input);

  /// The report of `flank plan`.
  std::string plan_report(const RollerPairCase &input);
} // namespace flank
