// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/folder_files.hpp"

#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace flank
{
  namespace fs = std::filesystem;

  bool is_there(const fs::path &path)
  {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
  }

  bool is_folder(const fs::path &path)
  {
    std::error_code error;
    return fs::symlink_status(path, error).type() == fs::file_type::directory;
  }

  bool is_as_listed(const fs::path &path, const Fingerprint &fingerprint)
  {
    try
      {
        return fingerprint_of_file(path) == fingerprint;
      }
    catch (const OutputError &)
      {
        return false;
      }
  }

  void remove_if_empty(const fs::path &folder)
  {
    rmdir(folder.c_str()); // refuses what holds anything
  }

  std::vector<std::string> files_in(const fs::path &folder)
  {
    std::vector<std::string> result;
    std::error_code error;
    if (!is_folder(folder))
      return result;
    for (auto it = fs::recursive_directory_iterator(folder, error);
         !error && it != fs::recursive_directory_iterator(); it.increment(error))
      if (it->symlink_status(error).type() == fs::file_type::regular)
        result.push_back(it->path().lexically_relative(folder).string());
    return result;
  }

  void synchronise(const fs::path &path)
  {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const int done = file < 0 ? -1 : fsync(file);
    const int why = errno;
    if (file >= 0)
      close(file);
    if (done != 0 && why != EINVAL && why != EROFS)
      throw OutputError(fmt::format("cannot write {}: {}", path.string(), std::strerror(why)));
  }

  std::error_code try_to_make_folder(const fs::path &path)
  {
    std::error_code problem;
    fs::create_directories(path, problem);
    if (!problem && !fs::is_directory(path, problem) && !problem)
      return std::make_error_code(std::errc::not_a_directory);
    return problem;
  }

  void make_folder(const fs::path &path)
  {
    if (const std::error_code problem = try_to_make_folder(path))
      throw OutputError(fmt::format("{} cannot be made: {}", path.string(), problem.message()));
  }
} // namespace flank
