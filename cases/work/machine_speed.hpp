// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank
{
  /// Floating-point operations a second of one core in a dense factorisation, the kind of work that
  /// everything here comes to: measured now, in some hundredths of a second. [1/s]
  double operations_a_second();
} // namespace flank
