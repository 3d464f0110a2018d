// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

/// What a function of another file returns, of namespace flank; declared where it stands in a list, so that
/// an entry is one line. Function, without arguments.
#define FLANK_LISTED(type, function)                                                                         \
  []() -> type {                                                                                             \
    extern type function();                                                                                  \
    return function();                                                                                       \
  }()
