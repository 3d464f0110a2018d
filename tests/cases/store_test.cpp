// SPDX-License-Identifier: GPL-2.0-or-later
// What is kept on disk: the operator cache and the journal of finished positions.
#include "cases/journal.hpp"
#include "cases/operator_cache.hpp"
#include "mesh/base/errors.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

using namespace flank;
namespace fs = std::filesystem;

namespace
{
  std::string fresh_folder(const std::string &name)
  {
    const fs::path path = fs::path(testing::TempDir()) / ("flank_store_" + name);
    fs::remove_all(path);
    fs::create_directories(path);
    return path.string();
  }

  std::vector<char> bytes(const std::size_t count, const char value)
  {
    return std::vector<char>(count, value);
  }
} // namespace

TEST(OperatorCache, GivesBackWhatItWasGiven)
{
  const OperatorCache cache(fresh_folder("cache"));
  EXPECT_FALSE(cache.load("body one"));
  cache.store("body one", bytes(1000, 'a'));
  cache.store("body two", bytes(500, 'b'));
  EXPECT_EQ(*cache.load("body one"), bytes(1000, 'a'));
  EXPECT_EQ(*cache.load("body two"), bytes(500, 'b'));
  EXPECT_TRUE(cache.holds("body one"));
  EXPECT_FALSE(cache.load("body three"));
  cache.store("body one", bytes(10, 'c')); // replaced
  EXPECT_EQ(*cache.load("body one"), bytes(10, 'c'));
}

TEST(OperatorCache, EveryDamagedByteIsFound)
{
  const OperatorCache cache(fresh_folder("damage"));
  const std::string   key = "teeth 50";
  cache.store(key, bytes(40, 'a'));
  const auto size = fs::file_size(cache.path(key));
  for (std::uintmax_t at = 0; at < size; ++at)
    {
      if (at >= 28 && at < 32)
        continue; // four unused bytes of the head
      cache.store(key, bytes(40, 'a'));
      std::fstream file(cache.path(key), std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(at));
      const char changed = static_cast<char>(file.get() ^ 1);
      file.seekp(static_cast<std::streamoff>(at));
      file.put(changed);
      file.close();
      EXPECT_FALSE(cache.load(key)) << "byte " << at;
      EXPECT_FALSE(fs::exists(cache.path(key))) << "byte " << at;
    }
  cache.store(key, bytes(40, 'a'));
  fs::resize_file(cache.path(key), size - 1);
  EXPECT_FALSE(cache.load(key));
}

TEST(OperatorCache, BoundedWhatWasUsedLongestAgoGoesFirst)
{
  const OperatorCache cache(fresh_folder("bounded"), 3500);
  const auto          now = fs::file_time_type::clock::now();
  for (int i = 0; i < 3; ++i)
    {
      cache.store("body " + std::to_string(i), bytes(1000, 'a'));
      fs::last_write_time(cache.path("body " + std::to_string(i)), now - std::chrono::hours(10 - i));
    }
  EXPECT_TRUE(cache.load("body 0")); // used now: the youngest
  cache.store("body 3", bytes(1000, 'a'));
  EXPECT_TRUE(cache.holds("body 0"));
  EXPECT_FALSE(cache.holds("body 1"));
  EXPECT_TRUE(cache.holds("body 2"));
  EXPECT_TRUE(cache.holds("body 3"));
  cache.store("too large for it all", bytes(5000, 'a'));
  EXPECT_FALSE(cache.holds("too large for it all"));
  EXPECT_TRUE(cache.holds("body 3"));
}

TEST(Journal, ReadsWholeRecordsAndLeavesABrokenTailOut)
{
  const std::string folder = fresh_folder("journal");
  {
    Journal journal(folder, "case a", "0", false);
    for (int i = 0; i < 5; ++i)
      journal.append(i, bytes(100 + i, static_cast<char>('a' + i)));
    Journal other(folder, "case a", "1", true); // a second process's file
    other.append(7, bytes(3, 'z'));
  }
  const std::string path = folder + "/positions-0.journal";
  for (const int cut : { 0, 1, 60, 103 }) // bytes missing of the last record
    {
      const std::string copy = fresh_folder("journal_cut");
      fs::copy(folder, copy, fs::copy_options::overwrite_existing | fs::copy_options::recursive);
      fs::resize_file(copy + "/positions-0.journal", fs::file_size(path) - cut);
      Journal journal(copy, "case a", "0", true);
      EXPECT_EQ(journal.found(), cut == 0 ? 6u : 5u);
      EXPECT_EQ(*journal.find(3), bytes(103, 'd'));
      EXPECT_EQ(*journal.find(7), bytes(3, 'z'));
      EXPECT_EQ(journal.find(4) != std::nullopt, cut == 0);
      journal.append(4, bytes(104, 'e'));
      Journal again(copy, "case a", "2", true); // what was broken is written whole now
      EXPECT_EQ(again.found(), 6u);
    }
}

TEST(Journal, RefusesOtherInputsByName)
{
  const std::string folder = fresh_folder("other");
  {
    Journal journal(folder, "teeth = 50\ncrown = 2\n", "0", false);
    journal.append(1, bytes(10, 'a'));
  }
  try
    {
      Journal journal(folder, "teeth = 50\ncrown = 3\n", "0", true);
      FAIL() << "accepted";
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("\"crown = 2\" there, \"crown = 3\" now"), std::string::npos) << error.what();
    }
  Journal anew(folder, "teeth = 50\ncrown = 3\n", "0", false); // without resume it starts anew
  EXPECT_EQ(anew.found(), 0u);
  Journal::remove(folder);
  EXPECT_TRUE(fs::is_empty(folder));
}
