// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/journal.hpp"

#include "cases/files/checked_file.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace flank
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr char record_magic[8] = {
      'F', 'L', 'A', 'N', 'K', 'J', 'N', '3'
    }; // the last character is the format's version

    struct RecordHeader
    {
      char magic[8];
      std::uint64_t name_bytes, content_bytes;
      std::uint32_t own_checksum;  ///< CRC-32 of the three before
      std::uint32_t body_checksum; ///< CRC-32 of what the record belongs to, then name and content
    };
    constexpr std::uint64_t most_name_bytes = 1u << 24; // a key, with the tables it depends on

    std::uint32_t own_checksum_of(const RecordHeader &header)
    {
      return crc_of({ reinterpret_cast<const char *>(&header), offsetof(RecordHeader, own_checksum) });
    }

    /// belongs_to: CRC-32 of the journal's key, so that a record counts nowhere else; 0: of the key's own
    /// record.
    RecordHeader header_of(const std::string &name, const std::vector<char> &content,
                           const std::uint32_t belongs_to)
    {
      RecordHeader header{ .magic = {},
                           .name_bytes = name.size(),
                           .content_bytes = content.size(),
                           .own_checksum = 0,
                           .body_checksum = 0 };
      std::memcpy(header.magic, record_magic, sizeof record_magic);
      header.own_checksum = own_checksum_of(header);
      header.body_checksum = crc_of({ content.data(), content.size() }, crc_of(name, belongs_to));
      return header;
    }

    /// The record at an offset, if it is whole and belongs there.
    std::optional<Journal::Record> read_record(std::ifstream &stream, const std::uint64_t offset,
                                               const std::uint64_t size, const std::uint32_t belongs_to)
    {
      RecordHeader header{};
      stream.clear();
      stream.seekg(static_cast<std::streamoff>(offset));
      if (!stream.read(reinterpret_cast<char *>(&header), sizeof header) ||
          std::memcmp(header.magic, record_magic, sizeof record_magic) != 0 ||
          own_checksum_of(header) != header.own_checksum)
        return std::nullopt;
      const std::uint64_t left = size - std::min(size, offset + sizeof header);
      if (header.name_bytes > std::min(left, most_name_bytes) ||
          header.content_bytes > left - header.name_bytes)
        return std::nullopt;
      Journal::Record record{ std::string(header.name_bytes, '\0'), std::vector<char>(header.content_bytes) };
      if (!stream.read(record.name.data(), static_cast<std::streamsize>(record.name.size())) ||
          !stream.read(record.content.data(), static_cast<std::streamsize>(record.content.size())) ||
          header_of(record.name, record.content, belongs_to).body_checksum != header.body_checksum)
        return std::nullopt;
      return record;
    }

    /// Where the next record may begin, from an offset on.
    std::uint64_t next_magic(std::ifstream &stream, std::uint64_t from, const std::uint64_t size)
    {
      std::string part(1 << 16, '\0');
      for (; from < size; from += part.size() - sizeof record_magic)
        {
          stream.clear();
          stream.seekg(static_cast<std::streamoff>(from));
          stream.read(part.data(), static_cast<std::streamsize>(part.size()));
          const auto at = std::string_view(part.data(), static_cast<std::size_t>(stream.gcount()))
                              .find(std::string_view(record_magic, sizeof record_magic));
          if (at != std::string_view::npos)
            return from + at;
        }
      return size;
    }

    /// use(offset, record) for the whole records of a file that belong to the key, in their order; what is
    /// damaged or foreign between them is passed over. The first record is the key's own.
    template <class Use>
    void each_record(const std::string &path, const std::uint32_t key_checksum, const Use &use)
    {
      std::error_code error;
      const std::uint64_t size = fs::file_size(path, error);
      std::ifstream stream(path, std::ios::binary);
      for (std::uint64_t at = 0; !error && stream.is_open() && at < size;)
        if (auto record = read_record(stream, at, size, at == 0 ? 0 : key_checksum))
          {
            const std::uint64_t bytes = sizeof(RecordHeader) + record->name.size() + record->content.size();
            use(at, std::move(*record));
            at += bytes;
          }
        else
          at = next_magic(stream, at + 1, size);
    }

    /// The first line in which two texts differ, of the one and of the other.
    std::pair<std::string, std::string> first_difference(const std::string &a, const std::string &b)
    {
      std::size_t from = 0;
      while (from < a.size() && from < b.size() && a[from] == b[from])
        ++from;
      const auto line = [&](const std::string &text) {
        const auto begin = from == 0 ? 0 : text.rfind('\n', from - 1) + 1, end = text.find('\n', begin);
        constexpr std::size_t most_letters = 200;
        return begin >= text.size() ? std::string("(nothing)")
                                    : text.substr(begin, std::min(end - begin, most_letters));
      };
      return { line(a), line(b) };
    }

    const std::string key_name = "key"; // of the first record: what all of them depend on
  }                                     // namespace

  std::vector<std::string> Journal::files(const std::string &folder)
  {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto &entry : fs::directory_iterator(folder, error))
      if (const std::string name = entry.path().filename();
          name.starts_with("positions-") && name.ends_with(".journal") &&
          entry.symlink_status(error).type() == fs::file_type::regular)
        names.push_back(name);
    std::sort(names.begin(), names.end());
    return names;
  }

  Journal::Journal(std::string folder, std::string key, std::function<void()> require_folder)
      : folder_(std::move(folder))
      , key_(std::move(key))
      , require_folder_(std::move(require_folder))
  {
  }

  Journal::~Journal()
  {
    if (file_ >= 0)
      close(file_);
  }

  void Journal::reread()
  {
    found_.clear();
    for (const std::string &name : files(folder_))
      {
        const std::string file = folder_ + "/" + name;
        bool keyed = false;
        each_record(file, crc_of(key_), [&](const std::uint64_t offset, Record record) {
          if (offset == 0 && record.name == key_name)
            {
              const std::string stored(record.content.begin(), record.content.end());
              keyed = stored == key_;
              if (keyed)
                return;
              const auto [there, now] = first_difference(stored, key_);
              throw InputError(fmt::format(
                  "--resume: {} was made from other inputs: \"{}\" there, \"{}\" now; run without --resume",
                  file, there, now));
            }
          if (Place place{ .file = file, .offset = offset }; keyed && !rejected_.contains(place))
            found_[record.name].push_back(std::move(place));
        });
        if (!keyed)
          spdlog::warn("{} is damaged at its beginning: what it held is computed again", file);
      }
  }

  std::optional<std::vector<char>> Journal::find(const std::string &piece) const
  {
    const auto it = found_.find(piece);
    if (it == found_.end())
      return std::nullopt;
    const Place &place = it->second.front();
    std::error_code error;
    const std::uint64_t size = fs::file_size(place.file, error);
    std::ifstream stream(place.file, std::ios::binary);
    auto record = error || !stream ? std::nullopt : read_record(stream, place.offset, size, crc_of(key_));
    if (!record || record->name != piece)
      {
        spdlog::warn("{} was damaged since it was read: {} is computed again", place.file, piece);
        return std::nullopt;
      }
    return std::move(record->content);
  }

  void Journal::reject(const std::string &piece)
  {
    spdlog::warn("what the journal holds of {} is no such result: it is computed again", piece);
    const auto it = found_.find(piece);
    if (it == found_.end())
      return;
    rejected_.insert(it->second.front());
    it->second.erase(it->second.begin());
    if (it->second.empty())
      found_.erase(it);
  }

  /// A file that was not there, so that no other process's is written to.
  void Journal::open_own()
  {
    require_folder_();
    for (int number = 1; file_ < 0; ++number)
      {
        path_ = fmt::format("{}/positions-{}-{}.journal", folder_, process, number);
        file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (file_ < 0 && errno != EEXIST)
          throw OutputError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
      }
  }

  void Journal::append(const std::string &piece, const std::vector<char> &content)
  {
    const std::lock_guard lock(mutex_);
    const auto put = [&](const std::string &name, const std::vector<char> &body,
                         const std::uint32_t belongs_to) {
      const RecordHeader header = header_of(name, body, belongs_to);
      std::string bytes(reinterpret_cast<const char *>(&header), sizeof header);
      bytes += name;
      bytes.append(body.begin(), body.end());
      for (std::size_t at = 0; at < bytes.size();)
        {
          const ssize_t written = ::write(file_, bytes.data() + at, bytes.size() - at);
          if (written < 0 && errno == EINTR)
            continue;
          if (written < 0)
            {
              broken_ = true;
              throw OutputError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
            }
          at += static_cast<std::size_t>(written);
        }
    };
    if (broken_)
      throw OutputError(fmt::format("cannot write {}: it could not be written before", path_));
    if (file_ < 0)
      {
        open_own();
        put(key_name, { key_.begin(), key_.end() }, 0);
      }
    put(piece, content, crc_of(key_));
  }
} // namespace flank
