// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flank
{
  /// Finished pieces of work on disk, appended one by one: what a killed run had done is found again, a piece
  /// that was being written is left out. Each record carries the name of its piece, its size and checksums of
  /// both and of the journal's key, which are verified at every reading: a record of other inputs does not
  /// count. Every process writes a file of its own ("positions-0-1.journal"); files of others are only ever
  /// read.
  class Journal
  {
  public:
    struct Record
    {
      std::string name; ///< the piece of work, in words
      std::vector<char> content;
    };

    /// `key` names everything the work depends on; `require_folder` throws OutputError where the folder is
    /// somebody else's by now: it is asked before this process's file is made in it. Throws OutputError.
    Journal(
        std::string folder, std::string key, std::function<void()> require_folder = [] {});
    ~Journal();
    Journal(const Journal &) = delete;

    /// Looks for what all processes have finished by now, in the order of the files' names; of a piece that
    /// is there twice the first one counts that was not rejected. Throws InputError if a file was made from
    /// another key; a file that is no journal is left aside with a word.
    void reread();

    bool holds(const std::string &piece) const { return found_.contains(piece); }

    std::size_t found() const { return found_.size(); }

    /// The content of a piece, read from the disk and verified; nothing if that piece was not done when the
    /// journals were read, or is damaged now.
    std::optional<std::vector<char>> find(const std::string &piece) const;

    /// The record that find() gives is no sound one, whatever its checksums say: from now on it is as if it
    /// were not there, and the next one of this piece counts. Says so.
    void reject(const std::string &piece);

    /// Adds a piece to this process's file, which the first one makes. Safe to use from several threads.
    /// Throws OutputError, after which this journal takes nothing more.
    void append(const std::string &piece, const std::vector<char> &content);

    /// Names of the journals in a folder.
    static std::vector<std::string> files(const std::string &folder);

    /// What this process's file is called, such as "0" for rank 0, before the first append.
    std::string process = "0";

  private:
    struct Place
    {
      std::string file;
      std::uint64_t offset; ///< of the record

      auto operator<=>(const Place &) const = default;
    };
    void open_own();

    std::map<std::string, std::vector<Place>> found_; ///< each in the order of the files
    std::set<Place> rejected_;
    std::mutex mutex_;
    std::string folder_, key_, path_;
    std::function<void()> require_folder_;
    int file_ = -1;
    bool broken_ = false;
  };
} // namespace flank
