// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/journal.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <filesystem>

namespace flank
{
  namespace
  {
    namespace fs = std::filesystem;

    struct RecordHeader
    {
      std::uint64_t piece, bytes;
      std::uint64_t checksum; ///< CRC-32 of piece, bytes and content
    };
    constexpr std::uint64_t key_piece = ~std::uint64_t{ 0 };

    std::uint64_t checksum(const std::uint64_t piece, const std::vector<char> &content)
    {
      const std::uint64_t head[2] = { piece, content.size() };
      auto                sum     = crc32_z(0, reinterpret_cast<const Bytef *>(head), sizeof head);
      return crc32_z(sum, reinterpret_cast<const Bytef *>(content.data()), content.size());
    }

    void write(std::ofstream &stream, const std::uint64_t piece, const std::vector<char> &content)
    {
      const RecordHeader header{ piece, content.size(), checksum(piece, content) };
      stream.write(reinterpret_cast<const char *>(&header), sizeof header);
      stream.write(content.data(), static_cast<std::streamsize>(content.size()));
      stream.flush();
    }

    /// use(piece, offset of the content, content) for all whole records of a file, in their order.
    template <class Use>
    void each_record(const fs::path &path, const Use &use)
    {
      std::ifstream     stream(path, std::ios::binary);
      const auto        size = fs::file_size(path);
      std::vector<char> content;
      for (RecordHeader header{}; stream.read(reinterpret_cast<char *>(&header), sizeof header) && header.bytes <= size;)
        {
          const auto offset = static_cast<std::uint64_t>(stream.tellg());
          content.resize(header.bytes);
          if (!stream.read(content.data(), static_cast<std::streamsize>(content.size())) ||
              checksum(header.piece, content) != header.checksum)
            break;
          use(header.piece, offset, content);
        }
    }

    /// The first line in which two texts differ, of the one and of the other.
    std::pair<std::string, std::string> first_difference(const std::string &a, const std::string &b)
    {
      std::size_t from = 0;
      while (from < a.size() && from < b.size() && a[from] == b[from])
        ++from;
      const auto line = [&](const std::string &text) {
        const auto begin = from == 0 ? 0 : text.rfind('\n', from - 1) + 1, end = text.find('\n', begin);
        return begin >= text.size() ? std::string("(nothing)") : text.substr(begin, end - begin);
      };
      return { line(a), line(b) };
    }
  } // namespace

  bool Journal::is_journal(const std::string &name)
  {
    return name.starts_with("positions-") && name.ends_with(".journal");
  }

  void Journal::remove(const std::string &folder)
  {
    std::error_code ignored;
    for (const auto &entry : fs::directory_iterator(folder, ignored))
      if (is_journal(entry.path().filename()))
        fs::remove(entry.path(), ignored);
  }

  Journal::Journal(std::string folder, std::string key, const std::string &process, const bool resume)
      : folder_(std::move(folder))
      , key_(std::move(key))
      , path_(fmt::format("{}/positions-{}.journal", folder_, process))
  {
    if (resume)
      reread();
    // Written anew with what this process had, so that a broken tail is gone.
    const std::string beside = path_ + ".partial";
    stream_.open(beside, std::ios::binary);
    write(stream_, key_piece, { key_.begin(), key_.end() });
    for (auto &[piece, place] : found_)
      if (place.file == path_)
        {
          const std::vector<char> content = *find(piece);
          place.offset                    = static_cast<std::uint64_t>(stream_.tellp()) + sizeof(RecordHeader);
          write(stream_, piece, content);
        }
    if (!stream_)
      throw ComputationError(fmt::format("cannot write {}", beside));
    fs::rename(beside, path_); // the open stream follows the file
  }

  void Journal::reread()
  {
    found_.clear();
    for (const auto &entry : fs::directory_iterator(folder_))
      if (const std::string file = entry.path(); is_journal(entry.path().filename()))
        {
          bool first = true;
          each_record(file, [&](const std::uint64_t piece, const std::uint64_t offset, const std::vector<char> &content) {
            if (!first)
              found_[piece] = { file, offset, content.size() };
            else if (const std::string stored(content.begin(), content.end()); stored != key_)
              {
                const auto [there, now] = first_difference(stored, key_);
                throw InputError(fmt::format("--resume: {} was made from other inputs: \"{}\" there, \"{}\" now; run without --resume",
                                             file, there, now));
              }
            first = false;
          });
        }
  }

  std::optional<std::vector<char>> Journal::find(const std::uint64_t piece) const
  {
    const auto it = found_.find(piece);
    if (it == found_.end())
      return std::nullopt;
    std::vector<char> content(it->second.bytes);
    std::ifstream     stream(it->second.file, std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(it->second.offset));
    if (!stream.read(content.data(), static_cast<std::streamsize>(content.size())))
      throw ComputationError(fmt::format("cannot read {} again", it->second.file));
    return content;
  }

  void Journal::append(const std::uint64_t piece, const std::vector<char> &content)
  {
    const std::lock_guard lock(mutex_);
    write(stream_, piece, content);
    if (!stream_)
      throw ComputationError(fmt::format("cannot write {}: is the disk full?", path_));
  }
} // namespace flank
