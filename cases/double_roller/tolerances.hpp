// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/input.hpp"

namespace flank
{
  /// Keys of a drive as made: tolerances from which errors of single parts are drawn.
  std::vector<Key> tolerance_keys();

  /// Adds the errors that a case draws to those of its lists. Each is spread evenly between minus and plus
  /// its tolerance, and depends on the seed, its kind and the number of its part alone: another tolerance, or
  /// another number of parts, leaves it as it is. Throws InputError.
  void draw_errors(const CaseFile &file, DoubleRollerData &drive);
} // namespace flank
