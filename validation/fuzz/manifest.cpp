// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/manifest.hpp"
#include "validation/fuzz/harness.hpp"

namespace flank::fuzz
{
  std::string take_manifest(const std::string_view bytes)
  {
    const auto manifest = Manifest::parse(std::string(bytes));
    if (!manifest)
      return "it is no manifest";
    const auto again = Manifest::parse(manifest->text());
    require(again && again->program == manifest->program && again->command == manifest->command &&
                again->files == manifest->files && again->inputs == manifest->inputs,
            "a manifest that was written says the same when it is read");
    return "";
  }
} // namespace flank::fuzz
