// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/operator_cache.hpp"

#include "cases/files/checked_file.hpp"
#include "cases/work/host.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace flank
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr char operator_magic[8] = {
      'F', 'L', 'A', 'N', 'K', 'O', 'P', '1'
    }; // the last character is the format's version
    constexpr const char *extension = ".operator",
                         *temporary = ".operator.tmp-"; ///< temporary: followed by host, process and number

    struct Header
    {
      char magic[8];
      std::uint64_t key_bytes, payload_bytes;
      std::uint32_t checksum, unused; ///< CRC-32 of key and payload
    };

    std::uint32_t checksum(const std::string &key, const std::span<const char> payload)
    {
      return crc_of({ payload.data(), payload.size() }, crc_of(key));
    }

    /// Fowler-Noll-Vo hash, 64 bit: names the file; the key inside decides.
    std::uint64_t hash(const std::string &text)
    {
      std::uint64_t value = 14695981039346656037u;
      for (const char c : text)
        value = (value ^ static_cast<unsigned char>(c)) * 1099511628211u;
      return value;
    }

    constexpr std::size_t hash_digits = 16;

    /// Whether a file of this name could be the cache's own, with this ending behind its hash.
    bool is_named(const std::string &name, const std::string_view ending)
    {
      return name.size() > hash_digits && std::string_view(name).substr(hash_digits).starts_with(ending) &&
             name.find_first_not_of("0123456789abcdef") == hash_digits;
    }

    bool is_operator(const fs::path &path)
    {
      const std::string name = path.filename();
      return is_named(name, extension) && name.size() == hash_digits + std::strlen(extension);
    }

    bool is_temporary(const fs::path &path)
    {
      return is_named(path.filename(), temporary);
    }

    /// Whether the process that was writing a temporary file is gone: of this host it is known, elsewhere
    /// nobody takes a day.
    bool is_abandoned(const fs::path &path)
    {
      const std::string name = path.filename(),
                        owner = name.substr(name.find(temporary) + std::strlen(temporary)),
                        own = host_name() + "-";
      std::error_code error;
      const auto age = fs::file_time_type::clock::now() - fs::last_write_time(path, error);
      if (owner.starts_with(own)) // a container of the same name may write it, whose processes are not seen
        return kill(static_cast<pid_t>(std::atol(owner.c_str() + own.size())), 0) != 0 && errno == ESRCH &&
               !error && age > std::chrono::minutes(1);
      return !error && age > std::chrono::hours(24);
    }

    std::string users_folder()
    {
      const auto variable = [](const char *name) {
        const char *value = std::getenv(name);
        return std::string(value ? value : "");
      };
      if (const std::string given = variable("FLANK_CACHE"); !given.empty())
        return given;
      if (const std::string xdg = variable("XDG_CACHE_HOME"); xdg.starts_with('/')) // else to be ignored
        return xdg + "/flank";
      const std::string home = variable("HOME");
      return home.empty() ? "" : home + "/.cache/flank";
    }
  } // namespace

  const OperatorCache &OperatorCache::of_user()
  {
    static const OperatorCache cache = [] {
      std::string folder = users_folder();
      std::error_code error;
      if (!folder.empty())
        fs::create_directories(folder, error);
      if (folder.empty() || error || access(folder.c_str(), W_OK | R_OK | X_OK) != 0)
        {
          spdlog::warn("the operator cache {} cannot be written: going on without one (set FLANK_CACHE to a "
                       "folder that can)",
                       folder.empty() ? "folder" : folder);
          folder.clear();
        }
      OperatorCache result(folder);
      result.sweep();
      return result;
    }();
    return cache;
  }

  OperatorCache::OperatorCache(std::string folder, const std::size_t most_bytes)
      : folder_(std::move(folder))
      , most_bytes_(most_bytes)
  {
  }

  std::string OperatorCache::path(const std::string &key) const
  {
    return fmt::format("{}/{:016x}{}", folder_, hash(key), extension);
  }

  bool OperatorCache::holds(const std::string &key) const
  {
    std::error_code error;
    return !folder_.empty() && fs::symlink_status(path(key), error).type() == fs::file_type::regular;
  }

  std::optional<SharedBytes> OperatorCache::load(const std::string &key) const
  {
    if (folder_.empty())
      return std::nullopt;
    const std::string file = path(key);
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(file, error)))
      return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
      return std::nullopt;
    Header header{};
    const auto size = fs::file_size(file, error);
    std::string stored_key;
    std::shared_ptr<char[]> payload;
    bool whole =
        !error && size <= most_bytes_ && stream.read(reinterpret_cast<char *>(&header), sizeof header) &&
        std::memcmp(header.magic, operator_magic, sizeof operator_magic) == 0 && header.key_bytes < size &&
        header.payload_bytes < size && sizeof header + header.key_bytes + header.payload_bytes == size;
    if (whole)
      {
        stored_key.resize(header.key_bytes);
        payload = std::make_shared_for_overwrite<char[]>(header.payload_bytes);
        whole = stream.read(stored_key.data(), static_cast<std::streamsize>(stored_key.size())) &&
                stream.read(payload.get(), static_cast<std::streamsize>(header.payload_bytes)) &&
                checksum(stored_key, { payload.get(), header.payload_bytes }) == header.checksum;
      }
    if (!whole)
      {
        spdlog::warn("the cached operator {} is damaged or foreign: removed, computing it again", file);
        fs::remove(file, error);
        return std::nullopt;
      }
    if (stored_key != key)
      return std::nullopt;                                              // another operator of the same hash
    fs::last_write_time(file, fs::file_time_type::clock::now(), error); // used now
    return SharedBytes(payload, payload.get(), header.payload_bytes);
  }

  void OperatorCache::store(const std::string &key, const std::span<const char> payload) const
  {
    if (folder_.empty() || payload.size() > most_bytes_)
      return;
    static std::atomic<int> number{ 0 };
    const std::string file = path(key), beside = fmt::format("{}/{:016x}{}{}-{}-{}", folder_, hash(key),
                                                             temporary, host_name(), getpid(), number++);
    Header header{ .magic = {},
                   .key_bytes = key.size(),
                   .payload_bytes = payload.size(),
                   .checksum = checksum(key, payload),
                   .unused = 0 };
    std::memcpy(header.magic, operator_magic, sizeof operator_magic);
    std::error_code error;
    try
      {
        CheckedFile stream(beside);
        stream.write({ reinterpret_cast<const char *>(&header), sizeof header });
        stream.write(key);
        stream.write({ payload.data(), payload.size() });
        stream.finish();
        fs::rename(beside, file, error);
      }
    catch (const OutputError &problem)
      {
        spdlog::warn("the operator could not be kept: {}; going on without", problem.what());
        return;
      }
    if (error)
      {
        spdlog::warn("the operator could not be kept as {}: {}; going on without", file, error.message());
        fs::remove(beside, error);
        return;
      }
    evict();
  }

  void OperatorCache::sweep() const
  {
    std::error_code error;
    for (const auto &entry : fs::directory_iterator(folder_, error))
      if (is_temporary(entry.path()) && entry.symlink_status(error).type() == fs::file_type::regular &&
          is_abandoned(entry.path()))
        fs::remove(entry.path(), error);
  }

  void OperatorCache::forget(const std::string &key, const std::string &why) const
  {
    std::error_code error;
    spdlog::warn("the cached operator {} cannot be used ({}): removed, computing it again", path(key), why);
    fs::remove(path(key), error);
  }

  void OperatorCache::evict() const
  {
    struct Stored
    {
      fs::file_time_type used;
      std::uintmax_t bytes;
      fs::path path;
    };
    std::vector<Stored> all;
    std::uintmax_t total = 0;
    std::error_code error;
    for (const auto &entry : fs::directory_iterator(folder_, error))
      if (is_temporary(entry.path()))
        {
          const auto bytes =
              fs::file_size(entry.path(), error); // of a process that is writing: counts, and stays
          total += error ? 0 : bytes;
        }
      else if (is_operator(entry.path()))
        {
          const auto used = fs::last_write_time(entry.path(), error);
          const auto bytes = fs::file_size(entry.path(), error);
          if (!error) // another process may have removed it
            {
              all.push_back({ used, bytes, entry.path() });
              total += bytes;
            }
        }
    std::sort(all.begin(), all.end(), [](const Stored &a, const Stored &b) { return a.used < b.used; });
    for (std::size_t i = 0; i + 1 < all.size() && total > most_bytes_; ++i) // the newest stays
      {
        fs::remove(all[i].path, error);
        total -= all[i].bytes;
      }
  }
} // namespace flank
