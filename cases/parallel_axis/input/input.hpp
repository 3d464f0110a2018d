// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair_case.hpp"

namespace flank
{
  /// Throws InputError with file, line, key and value.
  ParallelAxisCase read_parallel_axis(const CaseFile &file);
} // namespace flank
