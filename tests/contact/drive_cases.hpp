// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/double_roller/input.hpp"
#include "cases/scenes.hpp"

namespace flank
{
  /// A ready case of the double-roller drive with further settings ("key=value").
  inline DoubleRollerCase drive_case(const std::string &name, const std::vector<std::string> &settings = {})
  {
    return read_double_roller(
        CaseFile::read(schema(), FLANK_ROOT "/cases/double_roller/" + name + ".toml", settings));
  }
} // namespace flank
