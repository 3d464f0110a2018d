// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/shared_memory.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace flank
{
  /// Operators on disk, one file each, found by a text that names everything they depend on. Safe for several
  /// processes: a file appears complete or not at all. Each file carries a format version, the whole key and
  /// a checksum, verified at every reading; what is damaged or foreign is removed with a word and computed
  /// again. Bounded in size: what was used longest ago goes first.
  class OperatorCache
  {
  public:
    /// $FLANK_CACHE, else flank/ in the user's XDG cache folder. Where that cannot be written: says so once
    /// and keeps nothing.
    static const OperatorCache &of_user();

    /// An empty folder: keeps nothing.
    explicit OperatorCache(std::string folder, std::size_t most_bytes = std::size_t{ 4 } << 30);

    /// The payload stored under a key, if it is there and whole.
    std::optional<SharedBytes> load(const std::string &key) const;

    /// Keeps a payload; where it cannot be written, says so and goes on.
    void store(const std::string &key, std::span<const char> payload) const;

    /// Removes what was stored under a key and says so: for content that has the right checksum and yet
    /// cannot be used.
    void forget(const std::string &key, const std::string &why) const;

    /// Removes what processes that are gone were writing.
    void sweep() const;

    /// Whether load() would find a file (its content is not verified). Changes nothing.
    bool holds(const std::string &key) const;

    const std::string &folder() const { return folder_; }

    /// File that a key is stored in.
    std::string path(const std::string &key) const;

  private:
    void evict() const;

    std::string folder_;
    std::size_t most_bytes_;
  };
} // namespace flank
