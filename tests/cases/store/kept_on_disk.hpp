// SPDX-License-Identifier: GPL-2.0-or-later
// What tests of the things kept on disk share: a folder of their own, and contents that are told apart.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace flank
{
  inline std::string fresh_folder(const std::string &name)
  {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("flank_store_" + name);
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
    return path.string();
  }

  inline std::vector<char> bytes(const std::size_t count, const char value)
  {
    return std::vector<char>(count, value);
  }
} // namespace flank
