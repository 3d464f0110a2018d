// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <mutex>
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
    /// Otherwise starts anew. process: number of the file this process writes.
    Journal(std::string folder, std::string key, int process, bool resume);

    /// Null if that piece is not done yet.
    const std::vector<char> *find(std::uint64_t piece) const;

    void append(std::uint64_t piece, const std::vector<char> &content);

    std::size_t found() const { return found_.size(); }

    /// Whether a file of a result folder is a journal.
    static bool is_journal(const std::string &name);

    /// Removes all journals of the folder: the results are complete.
    static void remove(const std::string &folder);

  private:
    std::map<std::uint64_t, std::vector<char>> found_;
    std::ofstream                              stream_;
    std::mutex                                 mutex_;
    std::string                                path_;
  };
} // namespace flank
