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

    /// All whole records of a file, in their order.
    std::vector<std::pair<std::uint64_t, std::vector<char>>> read(const fs::path &path)
    {
      std::vector<std::pair<std::uint64_t, std::vector<char>>> records;
      std::ifstream                                            stream(path, std::ios::binary);
      const auto                                               size = fs::file_size(path);
      for (RecordHeader header{}; stream.read(reinterpret_cast<char *>(&header), sizeof header) && header.bytes <= size;)
        {
          std::vector<char> content(header.bytes);
          if (!stream.read(content.data(), static_cast<std::streamsize>(content.size())) ||
              checksum(header.piece, content) != header.checksum)
            break;
          records.emplace_back(header.piece, std::move(content));
        }
      return records;
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

  Journal::Journal(std::string folder, std::string key, const int process, const bool resume)
      : path_(fmt::format("{}/positions-{}.journal", folder, process))
  {
    std::map<std::uint64_t, std::vector<char>> own;
    if (resume)
      for (const auto &entry : fs::directory_iterator(folder))
        if (is_journal(entry.path().filename()))
          {
            const auto records = read(entry.path());
            if (records.empty() || records.front().first != key_piece)
              continue; // killed before its first line was whole
            if (const std::string stored(records.front().second.begin(), records.front().second.end()); stored != key)
              {
                // Name the first line that differs.
                std::size_t from = 0;
                while (from < key.size() && from < stored.size() && key[from] == stored[from])
                  ++from;
                const auto line = [&](const std::string &text) {
                  const auto begin = from == 0 ? 0 : text.rfind('\n', from - 1) + 1, end = text.find('\n', begin);
                  return begin >= text.size() ? std::string("(nothing)") : text.substr(begin, end - begin);
                };
                throw InputError(fmt::format("--resume: {} was made from other inputs: \"{}\" there, \"{}\" now; run without --resume",
                                             entry.path().string(), line(stored), line(key)));
              }
            for (std::size_t i = 1; i < records.size(); ++i)
              {
                if (entry.path() == fs::path(path_))
                  own[records[i].first] = records[i].second;
                found_[records[i].first] = records[i].second;
              }
          }
    // Written anew with what this process had, so that a broken tail is gone.
    const std::string beside = path_ + ".partial";
    stream_.open(beside, std::ios::binary);
    write(stream_, key_piece, { key.begin(), key.end() });
    for (const auto &[piece, content] : own)
      write(stream_, piece, content);
    if (!stream_)
      throw ComputationError(fmt::format("cannot write {}", beside));
    fs::rename(beside, path_); // the open stream follows the file
  }

  const std::vector<char> *Journal::find(const std::uint64_t piece) const
  {
    const auto it = found_.find(piece);
    return it == found_.end() ? nullptr : &it->second;
  }

  void Journal::append(const std::uint64_t piece, const std::vector<char> &content)
  {
    const std::lock_guard lock(mutex_);
    write(stream_, piece, content);
    if (!stream_)
      throw ComputationError(fmt::format("cannot write {}: is the disk full?", path_));
  }
} // namespace flank
