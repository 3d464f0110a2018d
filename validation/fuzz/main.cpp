// SPDX-License-Identifier: GPL-2.0-or-later
// One harness as a libFuzzer program.
#include "validation/fuzz/harness.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerInitialize(int *, char ***)
{
  flank::fuzz::be_quiet();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  flank::fuzz::FLANK_HARNESS({ reinterpret_cast<const char *>(data), size });
  return 0;
}
