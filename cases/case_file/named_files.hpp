// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <map>
#include <mutex>
#include <string>

namespace flank
{
  /// The files that keys of a case name. Each is read once, at its first use: whoever asks for it later, for
  /// another variant or a finer computation, gets the same content, whatever has become of the file. Safe to
  /// use from several threads.
  class NamedFiles
  {
  public:
    /// Content of the file that is called `name` in the case and lies at `path`. Throws std::runtime_error as
    /// text_of() does, for the same file the same each time.
    const std::string &text(const std::string &name, const std::string &path);

    /// Name and checksum of every file that was asked for, also of those that cannot be read, line by line.
    std::string digests() const;

  private:
    struct File
    {
      std::string text, problem;
    };
    mutable std::mutex mutex_;
    std::map<std::string, File> files_;
  };
} // namespace flank
