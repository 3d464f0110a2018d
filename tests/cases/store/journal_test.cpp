// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of finished positions.
#include "cases/work/journal.hpp"
#include "mesh/base/errors.hpp"
#include "tests/cases/store/kept_on_disk.hpp"

#include <fstream>

using namespace flank;
namespace fs = std::filesystem;

namespace
{
  std::string piece(const int i)
  {
    return "position " + std::to_string(i) + " of 9, torques 35 70 N m";
  }

  std::vector<std::string> contents_of(const std::string &folder)
  {
    std::vector<std::string> result;
    for (const std::string &name : Journal::files(folder))
      {
        std::ifstream stream(folder + "/" + name, std::ios::binary);
        result.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
      }
    return result;
  }
} // namespace

TEST(Journal, ReadsWholeRecordsAndLeavesABrokenTailOut)
{
  const std::string folder = fresh_folder("journal");
  {
    Journal journal(folder, "case a");
    for (int i = 0; i < 5; ++i)
      journal.append(piece(i), bytes(100 + i, static_cast<char>('a' + i)));
    Journal other(folder, "case a"); // a second process's file
    other.process = "1";
    other.append(piece(7), bytes(3, 'z'));
  }
  const std::string path = folder + "/positions-0-1.journal";
  for (const int cut : { 0, 1, 60, 103 }) // bytes missing of the last record
    {
      const std::string copy = fresh_folder("journal_cut");
      fs::copy(folder, copy, fs::copy_options::overwrite_existing | fs::copy_options::recursive);
      fs::resize_file(copy + "/positions-0-1.journal", fs::file_size(path) - cut);
      Journal journal(copy, "case a");
      journal.reread();
      EXPECT_EQ(journal.found(), cut == 0 ? 6u : 5u);
      EXPECT_EQ(*journal.find(piece(3)), bytes(103, 'd'));
      EXPECT_EQ(*journal.find(piece(7)), bytes(3, 'z'));
      EXPECT_EQ(journal.find(piece(4)) != std::nullopt, cut == 0);
      journal.append(piece(4), bytes(104, 'e'));
      Journal again(copy, "case a");
      again.reread();
      EXPECT_EQ(again.found(), 6u);
    }
}

TEST(Journal, WhatIsThereIsNeverWrittenTo)
{
  // Several processes that read each other's files while each goes on: none moves another one's records.
  const std::string folder = fresh_folder("journal_untouched");
  {
    Journal journal(folder, "case a");
    for (int i = 0; i < 9; ++i)
      journal.append(piece(8 - i), bytes(50, static_cast<char>('a' + 8 - i)));
  }
  const auto before = contents_of(folder);
  Journal first(folder, "case a"), second(folder, "case a");
  first.reread();
  second.reread();
  first.append(piece(20), bytes(50, 'x'));
  second.append(piece(21), bytes(50, 'y'));
  for (int i = 0; i < 9; ++i)
    {
      EXPECT_EQ(*first.find(piece(i)), bytes(50, static_cast<char>('a' + i)));
      EXPECT_EQ(*second.find(piece(i)), bytes(50, static_cast<char>('a' + i)));
    }
  EXPECT_EQ(contents_of(folder).size(), 3u);
  EXPECT_EQ(contents_of(folder).front(), before.front());
}

TEST(Journal, UnorderedAndDuplicatedRecordsAreEachWhatTheySay)
{
  const std::string folder = fresh_folder("journal_order");
  for (const int order : { 1, 3, 2 })
    {
      Journal journal(folder, "case a");
      for (int i = 0; i < 7; ++i)
        journal.append(
            piece(i * order % 7),
            bytes(64, static_cast<char>('a' + i * order % 7))); // of equal size: only the name tells
    }
  Journal journal(folder, "case a");
  journal.reread();
  EXPECT_EQ(journal.found(), 7u);
  for (int i = 0; i < 7; ++i)
    EXPECT_EQ(*journal.find(piece(i)), bytes(64, static_cast<char>('a' + i)));
}

TEST(Journal, ARecordThatChangesAfterItWasFoundIsNotTaken)
{
  const std::string folder = fresh_folder("journal_changed");
  {
    Journal journal(folder, "case a");
    journal.append(piece(1), bytes(64, 'a'));
    journal.append(piece(2), bytes(64, 'b'));
  }
  Journal journal(folder, "case a");
  journal.reread();
  const std::string path = folder + "/positions-0-1.journal";
  const std::string content = contents_of(folder).front();
  const auto write = [&](const std::string &text) { std::ofstream(path, std::ios::binary) << text; };
  for (std::size_t at = content.find(std::string(64, 'a')) - 60; at < content.size();
       ++at) // every byte of the two records
    {
      std::string damaged = content;
      damaged[at] ^= 1;
      write(damaged);
      const auto one = journal.find(piece(1)), two = journal.find(piece(2));
      EXPECT_TRUE(!one || *one == bytes(64, 'a')) << at;
      EXPECT_TRUE(!two || *two == bytes(64, 'b')) << at;
      EXPECT_FALSE(one && two) << at;
    }
  // Two records of equal size exchanged: both checksums are right, and neither is taken for the other.
  const auto size = (content.size() - content.find("FLANKJN", 8)) / 2, first = content.size() - 2 * size;
  std::string exchanged =
      content.substr(0, first) + content.substr(first + size) + content.substr(first, size);
  write(exchanged);
  EXPECT_FALSE(journal.find(piece(1)));
  EXPECT_FALSE(journal.find(piece(2)));
  journal.reread();
  EXPECT_EQ(*journal.find(piece(1)), bytes(64, 'a'));
  EXPECT_EQ(*journal.find(piece(2)), bytes(64, 'b'));
}

TEST(Journal, RecordsOfAnotherKeyAreNone)
{
  const std::string folder = fresh_folder("journal_of_two"), other = fresh_folder("journal_of_another");
  {
    Journal journal(folder, "case a"), another(other, "case b");
    journal.append(piece(1), bytes(64, 'a'));
    for (int i = 1; i < 4; ++i)
      another.append(piece(i), bytes(64, 'b'));
  }
  std::ofstream(folder + "/positions-0-1.journal", std::ios::binary | std::ios::app)
      << contents_of(other).front();
  Journal journal(folder, "case a");
  journal.reread();
  EXPECT_EQ(journal.found(), 1U);
  EXPECT_EQ(*journal.find(piece(1)), bytes(64, 'a'));
}

TEST(Journal, DamageInTheMiddleLosesWhatIsDamagedAlone)
{
  const std::string folder = fresh_folder("journal_middle");
  {
    Journal journal(folder, "case a");
    for (int i = 0; i < 5; ++i)
      journal.append(piece(i), bytes(200, static_cast<char>('a' + i)));
  }
  const std::string path = folder + "/positions-0-1.journal";
  std::string content = contents_of(folder).front();
  const auto at = content.find(std::string(200, 'c'));
  content.replace(at - 60, 100, 100, '!'); // the third one's header and name and some of it
  std::ofstream(path, std::ios::binary) << content;
  Journal journal(folder, "case a");
  journal.reread();
  EXPECT_EQ(journal.found(), 4u);
  EXPECT_FALSE(journal.holds(piece(2)));
  EXPECT_EQ(*journal.find(piece(4)), bytes(200, 'e'));
}

TEST(Journal, RefusesOtherInputsByName)
{
  const std::string folder = fresh_folder("other");
  {
    Journal journal(folder, "teeth = 50\ncrown = 2\n");
    journal.append(piece(1), bytes(10, 'a'));
  }
  try
    {
      Journal journal(folder, "teeth = 50\ncrown = 3\n");
      journal.reread();
      FAIL() << "accepted";
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("\"crown = 2\" there, \"crown = 3\" now"), std::string::npos)
          << error.what();
    }
}
