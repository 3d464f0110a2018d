// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/schema.hpp"

namespace flank
{
  /// The keys of a case of parallel axes but for those of its extras, and what `gear.like` copies.
  SceneKeys pair_keys();
} // namespace flank
