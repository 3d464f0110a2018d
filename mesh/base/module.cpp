// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/module.hpp"

#include "mesh/base/errors.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace flank
{
  void *module_address(const char *module, const char *name)
  {
    // By its whole path: a name alone is looked for in LD_LIBRARY_PATH first, where another build's may lie.
    const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / module;
    void *handle = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void *address = handle ? dlsym(handle, name) : nullptr;
    if (!address)
      throw LibraryError(std::string("a part of the program cannot be loaded, it must lie beside it: ") +
                         dlerror());
    return address;
  }
} // namespace flank
