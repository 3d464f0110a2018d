// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/scene/scene.hpp"

namespace flank
{
  /// All kinds of drives.
  const std::vector<Scene> &scenes();

  /// The keys of all of them.
  const Schema &schema();

  /// Names of the files that any run or study writes, of any of them.
  std::vector<std::string> result_files();

  /// What a case is a case of.
  const Scene &scene_of(const CaseFile &file);
} // namespace flank
