// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/scene/scene.hpp"

namespace flank
{
  /// All kinds of drives.
  const std::vector<Scene> &scenes();

  /// The keys of all scenes.
  const Schema &schema();

  /// Names of the files that a run, a study or a report of any scene writes.
  std::vector<std::string> result_files();

  /// The scene that a case names.
  const Scene &scene_of(const CaseFile &file);
} // namespace flank
