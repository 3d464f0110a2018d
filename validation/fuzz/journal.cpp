// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/journal.hpp"
#include "cases/parallel_axis/pair/position_record.hpp"
#include "validation/fuzz/harness.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace flank::fuzz
{
  namespace
  {
    /// Right checksums wherever a record may begin that is not longer than what is there.
    void mend(std::string &bytes)
    {
      const auto checksum = [&](const std::size_t from, const std::size_t count, const uLong belongs_to = 0) {
        return static_cast<std::uint32_t>(
            crc32_z(belongs_to, reinterpret_cast<const Bytef *>(bytes.data() + from), count));
      };
      const uLong key = crc32_z(0, reinterpret_cast<const Bytef *>("key"), 3);
      for (std::size_t at = 0;
           (at = bytes.find("FLANKJN3", at)) != std::string::npos && bytes.size() - at >= 32;)
        {
          std::uint64_t sizes[2];
          std::memcpy(sizes, bytes.data() + at + 8, sizeof sizes);
          const std::uint64_t left = bytes.size() - at - 32;
          const bool fits = sizes[0] <= left && sizes[1] <= left - sizes[0];
          const std::uint32_t sums[2] = { checksum(at, 24),
                                          fits ? checksum(at + 32, sizes[0] + sizes[1], at == 0 ? 0 : key)
                                               : 0 };
          std::memcpy(bytes.data() + at + 24, sums, sizeof sums);
          at += fits ? 32 + sizes[0] + sizes[1] : 8;
        }
    }
  } // namespace

  std::string take_journal(const std::string_view bytes)
  {
    std::string content(bytes.substr(std::min<std::size_t>(1, bytes.size())));
    if (bytes.starts_with('m'))
      mend(content);
    std::ofstream(folder() + "/positions-0-1.journal", std::ios::binary) << content;
    bool is_any = false;
    const std::string words = refusal_of([&] {
      Journal journal(folder(), "key");
      journal.reread();
      for (const char *piece : { "a", "b" })
        if (const auto found = journal.find(piece))
          is_any = is_band(*found, { 1000, 500 }, 0.25, 2) || is_band(*found, { 0 }, 0.25, 1) || is_any;
    });
    return !words.empty() || is_any ? words : "nothing of it is used";
  }
} // namespace flank::fuzz
