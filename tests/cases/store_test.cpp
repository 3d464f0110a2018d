// SPDX-License-Identifier: GPL-2.0-or-later
// What is kept on disk: the operator cache and the journal of finished positions.
#include "cases/files/checked_file.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/journal.hpp"
#include "cases/work/operator_cache.hpp"
#include "cases/work/packing.hpp"
#include "contact/loaded/position_grid.hpp"
#include "mesh/base/errors.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>

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

// Whatever shapes or stiffens a body, or says how it is reduced, is in the key of its operator; a tip edge or
// a name is not.
TEST(OperatorKey, SeesEveryFieldThatTheOperatorDependsOn)
{
  const BodyDefinition base{ .gear = make_gear_pair(paper_pair(15)).pinion,
                             .resolution = {},
                             .model = {},
                             .max_offset = 3,
                             .near_field = {} };
  // All that there are: a new one does not compile until it is named here, and changed below.
  [[maybe_unused]] const auto &[degree, flank_rows, tooth_columns, face_layers, fillet_rows, fillet_columns,
                                root_land_columns, rim_layers] = base.resolution;
  [[maybe_unused]] const auto &[kind, segment_teeth, clamped_cuts, reduction, use_mid_plane] = base.model;
  [[maybe_unused]] const auto &[split, depth, points] = base.near_field;
  using Change = std::function<void(BodyDefinition &)>;
  const std::vector<Change> changes = {
    [](BodyDefinition &r) { r.gear.teeth += 1; },
    [](BodyDefinition &r) { r.gear.face_width *= 1.001; },
    [](BodyDefinition &r) { r.gear.tip_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.root_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.bore_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.fillet_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.youngs_modulus *= 1.001; },
    [](BodyDefinition &r) { r.gear.poissons_ratio *= 1.001; },
    [](BodyDefinition &r) { r.gear.reference_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.base_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.helix_angle *= 1.001; },
    [](BodyDefinition &r) { r.gear.base_helix_angle *= 1.001; },
    [](BodyDefinition &r) { r.gear.half_angle_at_base *= 1.001; }, // the tooth thickness
    [](BodyDefinition &r) { r.resolution.degree += 1; },
    [](BodyDefinition &r) { r.resolution.flank_rows += 1; },
    [](BodyDefinition &r) { r.resolution.tooth_columns += 2; },
    [](BodyDefinition &r) { r.resolution.face_layers += 1; },
    [](BodyDefinition &r) { r.resolution.fillet_rows += 1; },
    [](BodyDefinition &r) { r.resolution.fillet_columns += 1; },
    [](BodyDefinition &r) { r.resolution.root_land_columns += 1; },
    [](BodyDefinition &r) { r.resolution.rim_layers += 1; },
    [](BodyDefinition &r) { r.model.kind = BodyModel::Kind::segment; },
    [](BodyDefinition &r) { r.model.kind = BodyModel::Kind::segment, r.model.segment_teeth = 5; },
    [](BodyDefinition &r) { r.model.kind = BodyModel::Kind::segment, r.model.clamped_cuts = true; },
    [](BodyDefinition &r) { r.model.reduction = BodyModel::Reduction::direct; },
    [](BodyDefinition &r) { r.model.use_mid_plane = false; },
    [](BodyDefinition &r) { r.max_offset += 1; },
    [](BodyDefinition &r) { r.near_field.points += 1; },
    [](BodyDefinition &r) { r.near_field.split = Split::classical; },
    [](BodyDefinition &r) {
      r.near_field.split = Split::classical, r.near_field.depth = ClassicalDepth::line_fit;
    },
  };
  std::map<std::string, std::size_t> keys{ { operator_key(base), changes.size() } };
  for (std::size_t k = 0; k < changes.size(); ++k)
    {
      BodyDefinition changed = base;
      changes[k](changed);
      const auto [same, is_new] = keys.try_emplace(operator_key(changed), k);
      EXPECT_TRUE(is_new) << "changes " << k << " and " << same->second;
    }
  BodyDefinition other = base;
  other.gear.name = "another name";
  other.gear.tip_chamfer = 0.1;
  EXPECT_EQ(operator_key(other), operator_key(base));
}

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

TEST(Packing, HostileCountsAreRefused)
{
  // As many entries as no bytes are left for, a negative number of them, a matrix of 2^61 x 8 numbers (whose
  // product runs over).
  for (const std::int64_t count : { std::int64_t{ -1 }, std::int64_t{ 4 }, std::int64_t{ 1 } << 61,
                                    std::numeric_limits<std::int64_t>::max() })
    {
      Packer out;
      out.value(count);
      out.value(1.0), out.value(2.0), out.value(3.0);
      Unpacker list(out.result), shapes(out.result);
      EXPECT_THROW(list.values<double>(), UnusableRecord) << count;
    }
  for (const auto &[rows, columns] : { std::pair<std::int64_t, std::int64_t>{ std::int64_t{ 1 } << 61, 8 },
                                       { 8, std::int64_t{ 1 } << 61 },
                                       { -1, -1 },
                                       { 2, 1000 } })
    {
      Packer out;
      out.value(rows), out.value(columns);
      out.values(std::vector<double>(30, 1.0));
      Unpacker in(out.result);
      EXPECT_THROW(in.matrix(), UnusableRecord) << rows << " x " << columns;
    }
  const std::vector<char> nothing;
  Unpacker in(nothing);
  EXPECT_THROW(in.value<double>(), UnusableRecord);
}

TEST(Packing, OneListOfFieldsServesBothWays)
{
  struct Record
  {
    int number = 0;
    bool flag = false;
    std::string text;
    std::vector<double> values;
    Eigen::VectorXd vector;
    Eigen::Matrix3Xd places;
    std::vector<std::string> texts;
  };
  const auto fields = [](auto &archive, auto &r) {
    archive.fields(r.number, r.flag, r.text, r.values, r.vector, r.places);
    archive.list(r.texts, [](auto &to, auto &text) { to.fields(text); });
  };
  const Record record{
    7, true, "a, b", { 1, 2.5 }, Eigen::Vector3d(1, 2, 3), Eigen::Matrix3d::Identity(), { "", "c" }
  };
  Packer out;
  fields(out, record);
  Record read;
  Unpacker in(out.result);
  fields(in, read);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(std::tie(read.number, read.flag, read.text, read.values, read.texts),
            std::tie(record.number, record.flag, record.text, record.values, record.texts));
  EXPECT_EQ(read.vector, record.vector);
  EXPECT_EQ(read.places, record.places);

  // A list's number of entries is that of what can be read, and a matrix has the rows that its field has.
  for (const int count : { 1 << 30, 3, -1 })
    {
      Packer hostile;
      hostile.value(count);
      std::vector<std::string> texts;
      Unpacker from(hostile.result);
      EXPECT_THROW(from.list(texts, [](auto &to, auto &text) { to.fields(text); }), UnusableRecord) << count;
    }
  Packer wide;
  wide.matrix(Eigen::MatrixXd::Ones(2, 4));
  Unpacker from(wide.result);
  EXPECT_THROW(from.fields(read.places), UnusableRecord);
}

// Whatever places cells, besides the bodies, is in the identity under which variants of a study share
// compliance.
TEST(CellsIdentity, SeesEveryFieldThatPlacesCells)
{
  const GearPair base = make_gear_pair(paper_pair(15));
  using Change = std::function<void(GearPair &, ContactGridSize &)>;
  const std::vector<Change> changes = {
    [](GearPair &p, ContactGridSize &) { p.data.centre_distance += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.data.axial_offset += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.face_low += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.face_high += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.pinion.usable_tip_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.gear.usable_tip_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.pinion.tip_rounding += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.gear.tip_rounding += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.pinion.form_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.gear.form_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.data.pinion_hand = Hand::left; },
    [](GearPair &p, ContactGridSize &) { p.data.counter_clockwise_drive = !p.data.counter_clockwise_drive; },
    [](GearPair &, ContactGridSize &g) { g.slices += 2; },
    [](GearPair &, ContactGridSize &g) { g.profile_cells += 2; },
  };
  const std::string same = identity_of_cells(base, {});
  EXPECT_EQ(identity_of_cells(make_gear_pair(paper_pair(15)), {}), same);
  for (std::size_t k = 0; k < changes.size(); ++k)
    {
      GearPair pair = base;
      ContactGridSize grid;
      changes[k](pair, grid);
      EXPECT_NE(identity_of_cells(pair, grid), same) << "change " << k;
    }
}
