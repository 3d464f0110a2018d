// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/input.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/roller_pair/input.hpp"
#include "cases/study/study_axes.hpp"
#include "validation/fuzz/harness.hpp"

#include <set>

namespace flank::fuzz
{
  std::string take_case(const std::string_view bytes)
  {
    const auto read = [](const CaseFile &file) {
      if (file.text("scene") == "double_roller")
        read_double_roller(file);
      else if (file.text("scene") == "roller_pair")
        read_roller_pair(file);
      else
        read_parallel_axis(file);
      file.inputs();
    };
    return refusal_of([&] {
      const CaseFile file =
          CaseFile::of_text(schema(), std::string(bytes), FLANK_ROOT "/cases/parallel_axis/case.toml");
      if (!file.has_study())
        return read(file);
      const StudyAxes axes(file);
      const long last = axes.n_variants() - 1;
      for (const long variant : std::set<long>{ 0, last / 2, last })
        read(axes.variant(variant));
    });
  }
} // namespace flank::fuzz
