// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/module.hpp"

#include "mesh/base/errors.hpp"

#include <dlfcn.h>

namespace flank
{
  void *module_address(const char *module, const char *name)
  {
    void *handle = dlopen(module, RTLD_LAZY | RTLD_LOCAL);
    void *address = handle ? dlsym(handle, name) : nullptr;
    if (!address)
      throw ComputationError(std::string("a part of the program cannot be loaded, it must lie beside it: ") +
                             dlerror());
    return address;
  }
} // namespace flank
