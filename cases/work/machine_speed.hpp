// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  /// Floating-point operations a second of one core in a dense factorisation, the kind of work that
  /// reductions come to: measured once a process, in some hundredths of a second. [1/s]
  double operations_a_second();

  /// Logarithms a second of one core, one after the other, the kind of work that contact comes to: elementary
  /// functions, branches, numbers that are read once. How it compares with a dense factorisation differs
  /// between processors. Measured once a process, in some thousandths of a second. [1/s]
  double logarithms_a_second();

  /// A time or size that is expected, as plans write it: two digits, and never as 2.7e+02.
  std::string two_digits(double value);

  /// What a plan expects besides operations: starting the program and writing small results [s]. The least
  /// that `validation/run plan` finds the smallest cases of each kind to take.
  namespace start_seconds
  {
    constexpr double one_process = 0.2, ranks = 0.5;
    constexpr double elements = 0.9; ///< added where a section is meshed by Gmsh, its elements by deal.II
    constexpr double drive_or_study = 0.4;
  } // namespace start_seconds
} // namespace flank
