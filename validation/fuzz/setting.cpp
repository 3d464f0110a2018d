// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/input.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "validation/fuzz/harness.hpp"

namespace flank::fuzz
{
  std::string take_setting(const std::string_view bytes)
  {
    static const auto ready = [](const std::string &path) {
      return CaseFile::of_text(schema(), content(path), FLANK_ROOT "/" + path);
    };
    static const CaseFile gears = ready("cases/parallel_axis/helical.toml"),
                          drive = ready("cases/double_roller/crowned.toml");
    const bool of_drive = bytes.starts_with('d');
    const std::string setting(bytes.substr(bytes.empty() ? 0 : 1));
    return refusal_of([&] {
      const CaseFile file = (of_drive ? drive : gears).with({ setting }, "--set");
      if (file.text("scene") == "double_roller")
        read_double_roller(file);
      else
        read_parallel_axis(file);
    });
  }
} // namespace flank::fuzz
