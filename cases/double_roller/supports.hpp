// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/input.hpp"

namespace flank
{
  /// Keys of pins and bearings.
  std::vector<Key> support_keys();

  /// What carries the sleeves, as a case gives it; `drive`: its other parts, read already. Throws InputError.
  DriveSupports read_supports(const CaseFile &file, const DriveDefinition &drive);

  /// "pins".
  std::string name_of(SupportPart part);

  /// A line of the summary and of the plan: which supports are elastic, and that the others are rigid.
  std::string described(const DriveSupports &supports);
} // namespace flank
