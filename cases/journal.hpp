// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// Finished pieces of work on disk, appended one by one with a checksum each: what a killed run had done is read again, a piece
  /// that was being written is left out. One file a process ("positions-0.journal"), all of a folder are read.
  class Journal
  {
  public:
    /// `key` names everything the work depends on. resume: reads what is there; InputError if it was made from another key.
    /// Otherwise starts anew. process: names the file this process writes.
    Journal(std::string folder, std::string key, const std::string &process, bool resume);

    /// Looks again for what all processes have finished by now.
    void reread();

    bool holds(std::uint64_t piece) const { return found_.contains(piece); }

    /// Read from the disk; nothing if that piece was not done when the journals were read.
    std::optional<std::vector<char>> find(std::uint64_t piece) const;

    void append(std::uint64_t piece, const std::vector<char> &content);

    std::size_t found() const { return found_.size(); }

    /// Whether a file of a result folder is a journal.
    static bool is_journal(const std::string &name);

    /// Removes all journals of the folder: the results are complete.
    static void remove(const std::string &folder);

  private:
    struct Place
    {
      std::string   file;
      std::uint64_t offset, bytes;
    };
    std::map<std::uint64_t, Place> found_;
    std::ofstream                  stream_;
    std::mutex                     mutex_;
    std::string                    folder_, key_, path_;
  };
} // namespace flank
