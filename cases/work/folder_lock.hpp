// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace flank
{
  /// Who works in a folder, kept in a file of it: host, boot, process and a sign of life every few seconds,
  /// so that an owner that died is known as such on this host at once, and from another one after a while.
  class FolderLock
  {
  public:
    /// Whether an owner of another lock of the folder stands in the way of this one.
    using Conflicts = std::function<bool(const std::string &other)>;

    /// Takes the lock `name` (part of a file's name) in an existing folder. Throws InputError with the
    /// owner's host and process where it, or one that conflicts, is held by somebody alive; OutputError where
    /// the folder cannot be written.
    FolderLock(const std::string &folder, const std::string &name, const Conflicts &conflicts);

    /// What the lock's file says of this process.
    const std::string &owner() const;

    /// Whether the lock `name` of a folder is there and is this owner's: not where the folder was moved or
    /// removed, or the lock taken over. A file that is there and cannot be read now counts as the owner's.
    static bool is_held(const std::string &folder, const std::string &name, const std::string &owner);

    /// Gives the lock back.
    ~FolderLock();
    FolderLock(const FolderLock &) = delete;

    /// Whether a file of the folder belongs to its locks.
    static bool is_lock(const std::string &file_name);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace flank
