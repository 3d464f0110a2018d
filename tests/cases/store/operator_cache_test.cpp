// SPDX-License-Identifier: GPL-2.0-or-later
// The cache of operators, and the digest by which a key names what a file holds.
#include "cases/files/checked_file.hpp"
#include "cases/work/operator_cache.hpp"
#include "tests/cases/store/kept_on_disk.hpp"

#include <chrono>
#include <fstream>

using namespace flank;
namespace fs = std::filesystem;

namespace
{
  /// What is kept under a key, empty where nothing is.
  std::vector<char> kept(const OperatorCache &cache, const std::string &key)
  {
    const auto found = cache.load(key);
    return found ? std::vector<char>(found->data, found->data + found->size) : std::vector<char>();
  }
} // namespace

TEST(Digest, SeesTheContentAndTheNameOfAFile)
{
  EXPECT_EQ(digest("flank", "0.001"), digest("flank", "0.001"));
  EXPECT_NE(digest("flank", "0.001"), digest("flank", "0.002")); // as long
  EXPECT_NE(digest("flank", "0.001"), digest("other", "0.001"));
  EXPECT_EQ(digest("flank", ""), "");
}

TEST(OperatorCache, GivesBackWhatItWasGiven)
{
  const OperatorCache cache(fresh_folder("cache"));
  EXPECT_FALSE(cache.load("body one"));
  cache.store("body one", bytes(1000, 'a'));
  cache.store("body two", bytes(500, 'b'));
  EXPECT_EQ(kept(cache, "body one"), bytes(1000, 'a'));
  EXPECT_EQ(kept(cache, "body two"), bytes(500, 'b'));
  EXPECT_TRUE(cache.holds("body one"));
  EXPECT_FALSE(cache.load("body three"));
  cache.store("body one", bytes(10, 'c')); // replaced
  EXPECT_EQ(kept(cache, "body one"), bytes(10, 'c'));
}

TEST(OperatorCache, EveryDamagedByteIsFound)
{
  const OperatorCache cache(fresh_folder("damage"));
  const std::string key = "teeth 50";
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
  const auto now = fs::file_time_type::clock::now();
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

TEST(OperatorCache, WhatIsLargerThanTheCacheIsNotRead)
{
  const std::string folder = fresh_folder("huge");
  const OperatorCache cache(folder, 3500), larger(folder, 1 << 20);
  larger.store("body", bytes(100000, 'a'));
  EXPECT_FALSE(cache.load("body"));
  EXPECT_FALSE(cache.holds("body")); // removed: it would be met at every run
}

TEST(OperatorCache, RemovesNothingButItsOwn)
{
  const std::string folder = fresh_folder("foreign");
  const OperatorCache cache(folder, 3500);
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1000);
  const std::vector<std::string> foreign = { "phone.operator", "0123456789abcdef0.operator",
                                             "0123456789ABCDEF.operator", "notes.operator.tmp-x-1-1" };
  for (const std::string &name : foreign)
    {
      std::ofstream(folder + "/" + name) << std::string(3000, 'x');
      fs::last_write_time(folder + "/" + name, long_ago);
    }
  for (int i = 0; i < 6; ++i)
    cache.store("body " + std::to_string(i), bytes(1000, 'a'));
  cache.sweep();
  for (const std::string &name : foreign)
    EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;
  EXPECT_FALSE(cache.holds("body 0"));
}
