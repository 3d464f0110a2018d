// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/input/topography_file.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "validation/fuzz/harness.hpp"

#include <cmath>

namespace flank::fuzz
{
  std::string take_topography(const std::string_view bytes)
  {
    static const MemoryFile table(200);
    static const CaseFile ready =
        CaseFile::of_text(schema(), content("cases/parallel_axis/helical.toml"), MemoryFile::beside());
    static const GearPair pair = read_parallel_axis(ready).pair;
    static const std::string key = "pinion.topography.file";
    static const CaseFile file = ready.with({ key + "=200" }, "--set");
    table.set(bytes);
    return refusal_of([&] {
      for (const bool mirrored : { false, true })
        {
          const auto topography = read_topography(file, key, pair, mirrored ? pair.gear : pair.pinion,
                                                  mirrored ? pair.gear_roll : pair.pinion_roll, mirrored);
          topography->describe(pair.pinion.base_radius);
          for (int i = 0; i <= 8; ++i)
            for (int j = 0; j <= 8; ++j)
              require(std::isfinite(topography->removed(pair.pinion_roll.tip * (0.7 + 0.04 * i),
                                                        pair.face_low + j * pair.common_face_width / 8)),
                      "what is removed is finite");
        }
    });
  }
} // namespace flank::fuzz
