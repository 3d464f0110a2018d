// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file.hpp"
#include "cases/result_folder.hpp"

#include <functional>
#include <string>

namespace flank
{
  /// A kind of drive. A new one is a folder under cases/ that makes one of these, and its keys in the schema.
  struct Scene
  {
    std::string                                  name;
    std::function<std::string(const CaseFile &)> check; ///< the report of `flank check`
    std::function<std::string(const CaseFile &, const ResultFolder &, const std::string &)>
        run; ///< computes, writes, returns the summary; last argument: versions
  };

  Scene parallel_axis_scene();
  Scene double_roller_scene();
} // namespace flank
