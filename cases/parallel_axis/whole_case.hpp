// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair/pair_case.hpp"

namespace flank
{
  /// All keys of a case of parallel axes, those of its extras the last.
  SceneKeys parallel_axis_keys();

  /// A case with the extras that it asks for. Throws InputError with file, line, key and value; so does a key
  /// that nothing has asked for.
  ParallelAxisCase read_parallel_axis(const CaseFile &file);
} // namespace flank
