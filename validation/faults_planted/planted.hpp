// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

// Included before every source file of the copy in build/planted (the compiler's -include): which of the
// planted faults is on, by the environment variable FLANK_PLANTED, the name of one in faults.txt. Read once,
// at the start of every program and module, so all threads and all ranks that mpirun starts have the same.
#if __cplusplus >= 202002L
#include <cstdlib>

namespace flank_planted_faults
{
  /// Fowler-Noll-Vo hash, 64 bit.
  constexpr unsigned long long hash(const char *name)
  {
    unsigned long long value = 14695981039346656037ull;
    for (; *name != '\0'; ++name)
      value = (value ^ static_cast<unsigned char>(*name)) * 1099511628211ull;
    return value;
  }

  struct Name
  {
    unsigned long long value;
    consteval Name(const char *name)
        : value(hash(name))
    {
    }
  };

  inline unsigned long long chosen()
  {
    const char *name = std::getenv("FLANK_PLANTED");
    return hash(name != nullptr ? name : "");
  }

  inline const unsigned long long on = chosen(); // before anything of its file that asks for it
} // namespace flank_planted_faults

inline bool flank_planted(const flank_planted_faults::Name name)
{
  return flank_planted_faults::on == name.value;
}
#endif
