// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/work/manifest.hpp"

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace flank
{
  /// Neither followed nor opened.
  bool is_there(const std::filesystem::path &path);

  /// A folder itself, not a link to one.
  bool is_folder(const std::filesystem::path &path);

  /// Does a file still have the content that a manifest lists?
  bool is_as_listed(const std::filesystem::path &path, const Fingerprint &fingerprint);

  void remove_if_empty(const std::filesystem::path &folder);

  /// Paths from a folder to the regular files in it, however deep; links are none.
  std::vector<std::string> files_in(const std::filesystem::path &folder);

  /// What was written is on the disk. Throws OutputError.
  void synchronise(const std::filesystem::path &path);

  /// With all folders above it. Returns why not.
  std::error_code try_to_make_folder(const std::filesystem::path &path);

  /// The same. Throws OutputError.
  void make_folder(const std::filesystem::path &path);
} // namespace flank
