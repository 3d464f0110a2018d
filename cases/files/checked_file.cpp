// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/files/checked_file.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace flank
{
  namespace
  {
    constexpr std::size_t buffered = 1 << 20;

    /// A file descriptor that closes itself.
    struct Descriptor
    {
      int file;
      ~Descriptor()
      {
        if (file >= 0)
          close(file);
      }
    };

    [[noreturn]] void refuse(const std::string &path)
    {
      throw OutputError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
    }
  } // namespace

  CheckedFile::CheckedFile(std::string path)
      : path_(std::move(path))
      , file_(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666))
  {
    if (file_ < 0)
      refuse(path_);
  }

  CheckedFile::~CheckedFile()
  {
    if (file_ < 0)
      return;
    close(file_);
    unlink(path_.c_str());
  }

  void CheckedFile::write(const std::string_view bytes)
  {
    buffer_.append(bytes);
    if (buffer_.size() >= buffered)
      flush();
  }

  void CheckedFile::flush()
  {
    const char *from = buffer_.data();
    for (std::size_t left = buffer_.size(); left > 0;)
      {
        const ssize_t written = ::write(file_, from, left);
        if (written < 0 && errno == EINTR)
          continue;
        if (written < 0)
          refuse(path_);
        from += written;
        left -= static_cast<std::size_t>(written);
      }
    buffer_.clear();
  }

  void CheckedFile::finish()
  {
    flush();
    if (fsync(file_) != 0 && errno != EINVAL && errno != EROFS) // some file systems cannot
      refuse(path_);
    const int file = std::exchange(file_, -1);
    if (close(file) != 0)
      {
        const int reason = errno;
        unlink(path_.c_str());
        errno = reason;
        refuse(path_);
      }
  }

  std::string content_of(const std::string &path, const std::uint64_t most)
  {
    const Descriptor d{ open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY) };
    struct stat state = {};
    if (d.file < 0 || fstat(d.file, &state) != 0)
      throw std::runtime_error(fmt::format("cannot be read ({})", std::strerror(errno)));
    if (!S_ISREG(state.st_mode))
      throw std::runtime_error(S_ISDIR(state.st_mode) ? "is a folder" : "is not a regular file");
    if (static_cast<std::uint64_t>(state.st_size) > most)
      throw std::runtime_error(fmt::format("has {} bytes, at most {} are read", state.st_size, most));
    std::string content;
    char part[1 << 16];
    for (ssize_t n; (n = read(d.file, part, sizeof part)) != 0;)
      {
        if (n < 0 && errno == EINTR)
          continue;
        if (n < 0)
          throw std::runtime_error(fmt::format("cannot be read ({})", std::strerror(errno)));
        content.append(part, static_cast<std::size_t>(n));
        if (content.size() > most)
          throw std::runtime_error(fmt::format("has more than {} bytes", most));
      }
    return content;
  }

  std::string text_of(const std::string &path, const std::uint64_t most)
  {
    std::string text = content_of(path, most);
    if (text.find('\0') != std::string::npos)
      throw std::runtime_error("is no text: it holds a zero byte");
    constexpr std::string_view mark = "\xef\xbb\xbf";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
  }

  Fingerprint fingerprint_of_file(const std::string &path)
  {
    const Descriptor d{ open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW) };
    struct stat state = {};
    if (d.file < 0 || fstat(d.file, &state) != 0 || !S_ISREG(state.st_mode))
      throw OutputError(fmt::format("{} cannot be read back", path));
    Fingerprint result;
    std::vector<char> part(1 << 20);
    for (ssize_t n; (n = read(d.file, part.data(), part.size())) != 0;)
      {
        if (n < 0 && errno == EINTR)
          continue;
        if (n < 0)
          throw OutputError(fmt::format("{} cannot be read back: {}", path, std::strerror(errno)));
        result.crc = crc_of({ part.data(), static_cast<std::size_t>(n) }, result.crc);
        result.size += static_cast<std::uint64_t>(n);
      }
    return result;
  }

  Fingerprint fingerprint_of(const std::string_view content)
  {
    return { content.size(), crc_of(content) };
  }

  std::uint32_t crc_of(const std::string_view bytes, const std::uint32_t before)
  {
    return static_cast<std::uint32_t>(
        crc32_z(before, reinterpret_cast<const Bytef *>(bytes.data()), bytes.size()));
  }

  std::string digest(const std::string &name, const std::string_view content)
  {
    const Fingerprint f = fingerprint_of(content);
    return content.empty() ? "" : fmt::format("{}: {:08x}, {} bytes\n", name, f.crc, f.size);
  }
} // namespace flank
