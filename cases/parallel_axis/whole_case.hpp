// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair/pair_case.hpp"

namespace flank
{
  /// All keys of a case of parallel axes, those of its extras the last.
  SceneKeys parallel_axis_keys();

  /// A case with the extras that it asks for, those of loaded teeth where any are. Throws InputError with
  /// file, line, key and value; so does a key that nothing has asked for.
  ParallelAxisCase read_parallel_axis(const CaseFile &file);

  /// The same of a case as the user gives it for a run: outputs of loaded teeth are refused where none are.
  ParallelAxisCase read_run(const CaseFile &file);
} // namespace flank
