// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// A cell that a spreadsheet takes as it is: commas and quotes do not end it, a text is no formula,
  /// control characters are gone.
  std::string csv_cell(std::string text);
} // namespace flank
