// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"

#include "mesh/base/errors.hpp"

#include <algorithm>

namespace flank
{
  void require_loaded(const CaseFile &file, const std::string &key, const ParallelAxisCase &input)
  {
    if (std::ranges::all_of(input.torques, [](const double torque) { return torque == 0; }))
      throw InputError(file.place(key) + "needs a loaded pair: every torque of load.pinion_torque_Nm is 0");
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
