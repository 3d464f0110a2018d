// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank
{
  /// Address of a name in a module (shared library) beside the program, which is loaded at the first call and
  /// stays. What the module brings along stays hidden from everyone else. Throws LibraryError where it cannot
  /// be loaded.
  void *module_address(const char *module, const char *name);

  /// A function of a module; otherwise as module_address().
  template <class Function>
  Function *module_function(const char *module, const char *name)
  {
    return reinterpret_cast<Function *>(module_address(module, name));
  }
} // namespace flank
