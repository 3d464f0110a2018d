// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace flank
{
  /// A new file, written in one go. Opened exclusively: nobody's file, link or pipe is ever written through.
  /// Every write is checked, and so are flushing to the disk and closing, which finish() does; what is not
  /// finished is removed. Throws OutputError.
  class CheckedFile
  {
  public:
    explicit CheckedFile(std::string path);
    ~CheckedFile();
    CheckedFile(const CheckedFile &) = delete;

    void write(std::string_view bytes);

    /// Puts everything on the disk. From here on the file stays.
    void finish();

  private:
    void flush();

    std::string path_;
    std::string buffer_;
    int file_ = -1;
  };

  /// A regular file's content. `most`: its greatest size [bytes]. Never waits, as reading a pipe or a device
  /// would. Throws std::runtime_error that says in a few words why it cannot be had, without naming the file
  /// or what is in it.
  std::string content_of(const std::string &path, std::uint64_t most);

  /// A text file's content, without the mark of UTF-8 that spreadsheets put first. Throws as content_of(),
  /// and where it holds a zero byte.
  std::string text_of(const std::string &path, std::uint64_t most);

  /// Size and CRC-32 of a content.
  struct Fingerprint
  {
    std::uint64_t size = 0;
    std::uint32_t crc = 0;

    bool operator==(const Fingerprint &) const = default;
  };
  /// The fingerprint of a regular file's content. Throws OutputError where it cannot be read.
  Fingerprint fingerprint_of_file(const std::string &path);
  Fingerprint fingerprint_of(std::string_view content);

  /// CRC-32 of some bytes, going on from that of those before them.
  std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0);

  /// A line that stands for a content: "name: crc, size bytes". Empty for an empty content.
  std::string digest(const std::string &name, std::string_view content);
} // namespace flank
