// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/work_folder.hpp"

#include "cases/work/folder_files.hpp"
#include "cases/work/folder_lock.hpp"

#include <algorithm>
#include <cctype>

namespace flank
{
  namespace fs = std::filesystem;

  bool says_it_is_ours(const fs::path &work)
  {
    try
      {
        return is_folder(work) &&
               content_of(work / work_folder_marker, 1u << 30).starts_with(work_folder_marker_head);
      }
    catch (const std::runtime_error &)
      {
        return false;
      }
  }

  bool is_marker_at_work(const std::string &name)
  {
    const std::string head = std::string(work_folder_marker) + ".";
    return name.starts_with(head) && name.size() > head.size() &&
           std::all_of(name.begin() + static_cast<std::ptrdiff_t>(head.size()), name.end(),
                       [](const unsigned char c) { return std::isdigit(c) != 0; });
  }

  bool is_work_folder(const fs::path &folder)
  {
    if (!is_folder(folder))
      return false;
    for (const char *staged : { "new", "new/fields", "new/figures" })
      if (is_there(folder / staged) && !is_folder(folder / staged))
        return false;
    if (says_it_is_ours(folder))
      return true;
    std::error_code error;
    for (const auto &entry : fs::directory_iterator(folder, error))
      if (const std::string name = entry.path().filename();
          !FolderLock::is_lock(name) && !is_marker_at_work(name))
        return false;
    return !error;
  }
} // namespace flank
