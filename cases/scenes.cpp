// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/scenes.hpp"

#include "cases/scene/listed.hpp"

#include <algorithm>

namespace flank
{
  const std::vector<Scene> &scenes()
  {
    static const std::vector<Scene> all = {
      FLANK_LISTED(Scene, parallel_axis_scene),
      FLANK_LISTED(Scene, double_roller_scene),
      FLANK_LISTED(Scene, roller_pair_scene),
    };
    return all;
  }

  const Schema &schema()
  {
    static const Schema all = [] {
      std::vector<SceneKeys> keys;
      for (const Scene &scene : scenes())
        keys.push_back(scene.keys);
      return Schema(keys);
    }();
    return all;
  }

  std::vector<std::string> result_files()
  {
    // What several scenes, studies or reports write; a scene need not write all of it.
    std::vector<std::string> names = { "te.csv",    "harmonics.csv", "results.h5", "summary.txt",
                                       "case.toml", "designs.csv",   "study.h5",   "report.html" };
    for (const Scene &scene : scenes())
      names.insert(names.end(), scene.result_files.begin(), scene.result_files.end());
    return names;
  }

  const Scene &scene_of(const CaseFile &file)
  {
    const std::string name = file.text("scene"); // one of them: the schema says so
    return *std::find_if(scenes().begin(), scenes().end(),
                         [&](const Scene &scene) { return scene.keys.scene == name; });
  }
} // namespace flank
