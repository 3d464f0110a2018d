// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"

#include <algorithm>

namespace flank
{
  bool asks_for_root_stress(const ParallelAxisCase &input)
  {
    return std::ranges::any_of(input.extras,
                               [](const auto &extra) { return extra->name() == root_stress_name; });
  }

  ExtraKind on_request(
      const std::string &name, const std::string &key, const std::string &meaning, const std::string &file,
      const std::string &left_out,
      std::function<std::shared_ptr<const Extra>(const CaseFile &, const ParallelAxisCase &)> make,
      const std::string &fallback)
  {
    ExtraKind kind;
    kind.name = name;
    kind.keys = { keys::text(key, fallback, "yes: " + meaning, { "no", "yes" }) };
    if (!file.empty())
      kind.files = { file };
    kind.left_out = left_out + ": not asked for (" + key + ")";
    kind.asked = [key, make = std::move(make)](
                     const CaseFile &given, const ParallelAxisCase &input) -> std::shared_ptr<const Extra> {
      return given.text(key) == "yes" ? make(given, input) : nullptr;
    };
    return kind;
  }
} // namespace flank
