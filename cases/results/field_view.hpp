// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank
{
  extern const char *const field_view; ///< field_view.py: a ParaView script that opens the fields beside it
}
