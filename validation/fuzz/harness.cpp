// SPDX-License-Identifier: GPL-2.0-or-later
#include "validation/fuzz/harness.hpp"

#include "cases/double_roller/keys.hpp"
#include "cases/files/checked_file.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/roller_pair/keys.hpp"

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace flank::fuzz
{
  namespace fs = std::filesystem;

  void require(const bool holds, const char *what)
  {
    if (!holds)
      throw std::logic_error(what);
  }

  MemoryFile::MemoryFile(const int descriptor)
      : descriptor_(descriptor)
  {
    const int file = memfd_create("flank", 0);
    require(file >= 0 && dup2(file, descriptor) == descriptor, "a file in memory");
    close(file);
  }

  void MemoryFile::set(const std::string_view content) const
  {
    require(ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, content.data(), content.size(), 0) ==
                                                  static_cast<ssize_t>(content.size()),
            "a file in memory");
  }

  const std::string &MemoryFile::beside()
  {
    static const std::string name = "/proc/self/fd/case.toml";
    return name;
  }

  const std::string &folder()
  {
    struct Folder
    {
      Folder()
      {
        const fs::path memory = "/dev/shm";
        std::string name =
            ((fs::is_directory(memory) ? memory : fs::temp_directory_path()) / "flank_fuzz_XXXXXX").string();
        require(mkdtemp(name.data()) != nullptr, "a folder");
        path = name;
      }
      ~Folder()
      {
        std::error_code error;
        fs::remove_all(path, error);
      }
      std::string path;
    };
    static const Folder own;
    return own.path;
  }

  const Schema &schema()
  {
    static const Schema keys({ parallel_axis_keys(), double_roller_keys(), roller_pair_keys() });
    return keys;
  }

  void be_quiet()
  {
    spdlog::set_level(spdlog::level::off);
  }

  std::string content(const std::string &path_from_root)
  {
    return content_of(FLANK_ROOT "/" + path_from_root, 1u << 20);
  }
} // namespace flank::fuzz
