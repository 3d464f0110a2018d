// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair/pair_case.hpp"

namespace flank
{
  /// A case without its extras. Throws InputError with file, line, key and value.
  ParallelAxisCase read_pair(const CaseFile &file);
} // namespace flank
