// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study_axes.hpp"
#include "validation/fuzz/harness.hpp"

#include <set>

namespace flank::fuzz
{
  std::string take_axes(const std::string_view bytes)
  {
    static const MemoryFile designs(200);
    static const std::string base = content("cases/double_roller/crowned.toml") + "\n";
    const auto divider = bytes.find("\n---\n");
    designs.set(divider == std::string_view::npos ? "" : bytes.substr(divider + 5));
    return refusal_of([&] {
      const CaseFile file =
          CaseFile::of_text(schema(), base + std::string(bytes.substr(0, divider)), MemoryFile::beside());
      if (!file.has_study())
        throw InputError("no axes");
      const StudyAxes axes(file);
      const long last = axes.n_variants() - 1;
      require(last >= 0 && axes.shape().size() <= axes.keys().size(), "axes have points and keys");
      for (const long variant : std::set<long>{ 0, last / 2, last })
        {
          require(axes.values(variant).size() == axes.keys().size(), "a value a key");
          axes.variant(variant);
        }
      for (std::size_t axis = 0; axis < axes.shape().size(); ++axis)
        require(axes.variant_on_axis(axis, axes.shape()[axis] - 1) <= last, "variants on an axis");
      axes.text();
    });
  }
} // namespace flank::fuzz
