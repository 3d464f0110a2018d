// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/libraries/element_libraries.hpp"

#include "mesh/base/module.hpp"

#include <atomic>

namespace flank
{
  namespace
  {
    std::atomic<const ElementLibraries *> loaded{ nullptr };
  }

  const ElementLibraries &element_libraries()
  {
    static const ElementLibraries libraries =
        module_function<ElementLibraries()>("libflank_elements.so", "flank_element_libraries")();
    loaded = &libraries;
    return libraries;
  }

  void finish_element_libraries()
  {
    if (const ElementLibraries *libraries = loaded.exchange(nullptr))
      libraries->finish();
  }
} // namespace flank
