// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"

namespace flank
{
  /// The keys of a double-roller drive.
  SceneKeys double_roller_keys();
} // namespace flank
