// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/manifest.hpp"

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace flank
{
  /// Whether anything has this path, a link that leads nowhere too: nothing is followed or opened.
  bool is_there(const std::filesystem::path &path);

  /// Whether this path is that of a folder itself, not of a link to one.
  bool is_folder(const std::filesystem::path &path);

  /// Whether a file still has the content that a manifest lists.
  bool is_as_listed(const std::filesystem::path &path, const Fingerprint &fingerprint);

  /// Removes a folder in which nothing is; any other one stays.
  void remove_if_empty(const std::filesystem::path &folder);

  /// Paths from a folder to the regular files in it, however deep; links are none.
  std::vector<std::string> files_in(const std::filesystem::path &folder);

  /// Returns when what was written to this file or folder is on the disk. Throws OutputError.
  void synchronise(const std::filesystem::path &path);

  /// Makes a folder, with all folders above it. Returns why it could not; no error where the folder is there.
  std::error_code try_to_make_folder(const std::filesystem::path &path);

  /// Makes a folder, with all folders above it. Throws OutputError where it cannot.
  void make_folder(const std::filesystem::path &path);
} // namespace flank
