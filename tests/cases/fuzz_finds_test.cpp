// SPDX-License-Identifier: GPL-2.0-or-later
// What fuzzing (validation/fuzz) has found: every file of fuzz_finds goes to the harness that its name begins
// with, and is refused in words.
#include "validation/fuzz/harness.hpp"
#include "validation/fuzz/operator.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

using namespace flank;
namespace fs = std::filesystem;

TEST(FuzzFinds, AreRefusedInWords)
{
  const std::map<std::string, std::string (*)(std::string_view)> harnesses = {
    { "case", fuzz::take_case },         { "setting", fuzz::take_setting },
    { "axes", fuzz::take_axes },         { "topography", fuzz::take_topography },
    { "lcp", fuzz::take_lcp },           { "journal", fuzz::take_journal },
    { "operator", fuzz::take_operator }, { "manifest", fuzz::take_manifest },
  };
  int files = 0;
  for (const auto &entry : fs::directory_iterator(FLANK_ROOT "/tests/cases/fuzz_finds"))
    {
      const std::string name = entry.path().filename();
      std::ostringstream bytes;
      bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      const auto harness = harnesses.find(name.substr(0, name.find('-')));
      ASSERT_NE(harness, harnesses.end()) << name;
      std::string words;
      EXPECT_NO_THROW(words = harness->second(bytes.str())) << name;
      EXPECT_NE(words, "") << name;
      ++files;
    }
  EXPECT_GT(files, 0);
}

TEST(FuzzFinds, OperatorsWithAnotherNumberAnywhereAreRefusedInWordsOrUsed)
{
  for (const auto &[letter, split] : { std::pair{ 'p', Split::projected }, { 'c', Split::classical } })
    {
      const std::vector<char> sound = fuzz::small_operator(split);
      const auto words = [&, letter = letter](const std::vector<char> &bytes) {
        return fuzz::take_operator(letter + std::string(bytes.begin(), bytes.end()));
      };
      EXPECT_EQ(words(sound), "");
      for (std::size_t at = 0; at + sizeof(int) <= sound.size(); at += sizeof(int))
        for (const int value : { -1, 0, 1, 9, 64, 1 << 30 })
          {
            std::vector<char> bytes = sound;
            std::memcpy(bytes.data() + at, &value, sizeof value);
            EXPECT_NO_THROW(words(bytes)) << letter << ", byte " << at << ": " << value;
          }
    }
}
