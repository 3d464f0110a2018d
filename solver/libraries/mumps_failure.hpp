// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <new>

namespace flank
{
  /// INFOG(1) of MUMPS (Users' guide 5.5, section 8) as what it is: std::bad_alloc where memory is missing,
  /// ComputationError where the matrix is to blame, LibraryError for anything else below zero.
  inline void require_factored(const int info, const char *what)
  {
    switch (info)
      {
      case -5: // workspace of the analysis, then of the factorisation
      case -7:
      case -13:
      case -19:
        throw std::bad_alloc();
      case -6: // singular in structure, in numbers; not positive definite
      case -10:
      case -40:
        throw ComputationError(fmt::format(
            "the stiffness matrix could not be factored (MUMPS {}: INFOG(1) = {}): broken mesh or missing "
            "support",
            what, info));
      default:
        if (info < 0)
          throw LibraryError(fmt::format("MUMPS failed in its {} (INFOG(1) = {})", what, info));
      }
  }
} // namespace flank
