// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace flank
{
  /// The folder in a result folder that holds what is unfinished.
  inline constexpr const char *work_folder_name = "unfinished";
  inline constexpr const char *work_folder_marker =
      "flank.txt"; ///< in the work folder: whose it is, and which inputs it is made from
  inline constexpr const char *work_folder_marker_head =
      "Unfinished results of Flank, format 1. This folder goes when they "
      "are complete; flank run or study with --resume goes on with it.";

  /// Whether a work folder's marker, a regular file, begins as Flank's do; false where it cannot be read.
  bool says_it_is_ours(const std::filesystem::path &work);

  /// Whether a file there has the name of a marker that a process, by its number, is writing.
  bool is_marker_at_work(const std::string &name);

  /// Whether Flank made this work folder: its marker says so, or there is no marker yet and nothing else in
  /// it.
  bool is_work_folder(const std::filesystem::path &folder);
} // namespace flank
