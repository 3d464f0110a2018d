// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/named_files.hpp"

#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"
#include "cases/files/checked_file.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace flank
{
  const std::string &NamedFiles::text(const std::string &name, const std::string &path)
  {
    const std::lock_guard lock(mutex_);
    auto at = files_.find(name);
    if (at == files_.end())
      {
        File read;
        try
          {
            read.text = text_of(path, CaseFile::most_table_bytes);
          }
        catch (const std::runtime_error &error)
          {
            read.problem = error.what();
          }
        at = files_.emplace(name, std::move(read)).first;
      }
    const File &file = at->second;
    if (!file.problem.empty())
      throw std::runtime_error(file.problem);
    return file.text;
  }

  std::string NamedFiles::digests() const
  {
    const std::lock_guard lock(mutex_);
    std::string lines;
    for (const auto &[name, file] : files_)
      {
        const Fingerprint f = fingerprint_of(file.text);
        lines += file.problem.empty()
                     ? fmt::format("file {}: {:08x}, {} bytes\n", shown_key(name), f.crc, f.size)
                     : fmt::format("file {}: {}\n", shown_key(name), file.problem);
      }
    return lines;
  }
} // namespace flank
