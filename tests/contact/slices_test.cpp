// SPDX-License-Identifier: GPL-2.0-or-later
// Where the slices of a position lie: halved at corners of the flanks, touching on the involutes.
#include "contact/loaded/load_distribution.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

using namespace flank;

// A helical pair enters and leaves at a corner of the flanks, on a line that is short at first: slices are
// halved there, and cover the face as they did.
TEST(Corner, SlicesOfShortLinesAreHalvedAndCoverTheFaceAsBefore)
{
  const GearPair helical = make_gear_pair(paper_pair(25.232)), spur = make_gear_pair(paper_pair(0));
  const MeshDeviations none;
  int halved = 0, quartered = 0;
  for (int k = 0; k < 20; ++k)
    {
      const MeshPosition position(helical, none, k / 20.0);
      const std::vector<Slice> plain = position.slices(20);
      const auto [slices, undivided] = position.slices_finer_at_corners(20);
      EXPECT_EQ(undivided, static_cast<int>(plain.size()));
      std::map<int, double> before, after; // height of all slices of a pair
      std::set<int> numbers;
      for (const Slice &slice : plain)
        before[slice.pair] += slice.height;
      for (std::size_t s = 0; s < slices.size(); ++s)
        {
          after[slices[s].pair] += slices[s].height;
          numbers.insert(slices[s].number);
          halved += std::abs(slices[s].height - 0.5) < 1e-12;
          quartered += std::abs(slices[s].height - 0.25) < 1e-12;
          const Slice &last = slices[s > 0 ? s - 1 : 0];
          if (s > 0 && slices[s].pair == last.pair)
            {
              EXPECT_NEAR(slices[s].z - last.z, (slices[s].height + last.height) / 2, 1e-9);
            }
        }
      EXPECT_EQ(numbers.size(), slices.size());
      for (const auto &[pair, height] : before)
        EXPECT_NEAR(after[pair], height, 1e-9) << pair;
      EXPECT_EQ(MeshPosition(spur, none, k / 20.0).slices_finer_at_corners(20).first.size(),
                MeshPosition(spur, none, k / 20.0).slices(20).size());
    }
  EXPECT_GT(halved, 0);
  EXPECT_GT(quartered, 0);
  EXPECT_LT(halved + quartered, 20 * 60); // a few slices of two pairs at each position
}

// On a face wide enough lines begin and end inside it, at no corner; and what is long at one end of the face
// is not short for ending near it.
TEST(Corner, LinesThatEndInsideTheFaceOrAreLongAreNotHalved)
{
  PairData data = paper_pair(25.232);
  for (const double face : { 20.0, 200.0 })
    {
      data.pinion.face_width = data.gear.face_width = face;
      const GearPair pair = make_gear_pair(data);
      const MeshDeviations none;
      const double line = pair.length_of_action / std::tan(pair.base_helix_angle); // along the axis
      for (int k = 0; k < 20; ++k)
        {
          const MeshPosition position(pair, none, k / 20.0);
          std::map<int, std::pair<double, double>> on_path; // length, the same of finer slices
          for (const Slice &slice : position.slices(40))
            on_path[slice.pair].first += slice.tip_edge ? 0 : slice.height;
          for (const Slice &slice : position.slices_finer_at_corners(40).first)
            if (!slice.tip_edge && slice.height < 0.9 * face / 40)
              on_path[slice.pair].second += slice.height;
          for (const auto &[number, lengths] : on_path)
            if (lengths.first > 0.2 * std::min(face, line) + face / 40)
              {
                EXPECT_EQ(lengths.second, 0) << "pair " << number << " at phase " << k / 20.0;
              }
        }
    }
}

// Unmodified flanks carry up to their corners. With slices throughout as halving has made them there, the
// shares of all pairs are the same within what the rest of the grid does to them (0.0015; 0.015 unless they
// are halved).
TEST(Corner, SharesOfShortLinesAreThoseOfAFinerGrid)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const LoadedPair mesh = mesh_of(pair, {}, {}, {}, 20), finer = mesh_of(pair, {}, {}, {}, 80);
  for (const double phase : { 0.125, 0.375, 0.625, 0.875 })
    {
      const PositionResult result = mesh.solve(phase, { 5e3 })[0], truth = finer.solve(phase, { 5e3 })[0];
      std::map<int, double> differences;
      for (const PairLoad &load : result.pairs)
        differences[load.pair] += load_share(result, load);
      for (const PairLoad &load : truth.pairs)
        differences[load.pair] -= load_share(truth, load);
      for (const auto &[number, difference] : differences)
        EXPECT_NEAR(difference, 0, 0.003) << "pair " << number << " at phase " << phase;
    }
}

// A relief that begins at the base circle moves the closest places there, and none beyond, where there is no
// involute. (Windows about such places held no cells of slices that touch.)
TEST(Slices, TouchOnTheInvolute)
{
  const GearPair pair = make_gear_pair(twelve_tooth_pair(0));
  const MeshDeviations relieved = on_pinion(std::make_shared<ProfileRelief>(
      "tip relief", 0.3, 0, pair.pinion.tip_roll, ReliefShape::linear, pair.pinion.base_radius));
  int at_base = 0;
  for (int k = 0; k < 200; ++k)
    for (const Slice &slice : MeshPosition(pair, relieved, k / 200.0).slices(1))
      {
        const double end = profile_length(slice.pinion_roll, pair.pinion.form_roll, pair.pinion.base_radius);
        EXPECT_GT(slice.touch_offset, end - 1e-6)
            << "roll " << slice.pinion_roll << " at phase " << k / 200.0;
        at_base += slice.touch_offset < end + 1e-6;
      }
  EXPECT_LT(pair.pinion.form_roll, 1e-3);
  EXPECT_GT(at_base, 0);
}

// A tip so far from the other flank that no points of them face each other is no slice: each one touches
// somewhere.
TEST(Slices, TouchSomewhere)
{
  const MeshDeviations none;
  for (const GearPair &pair : { make_gear_pair(paper_pair(0)), make_gear_pair(paper_pair(25.232)),
                                make_gear_pair(twelve_tooth_pair(0)), make_gear_pair(twelve_tooth_pair(25)) })
    for (int k = 0; k < 100; ++k)
      for (const Slice &slice : MeshPosition(pair, none, k / 100.0).slices(11))
        EXPECT_LT(std::abs(slice.touch), 10) << pair.pinion.teeth << ' ' << k; // mm
}

// A narrow gear anywhere along a long pinion: whole axial pitches farther on the same slices meet, each of a
// pair as many further back. (Pairs were once numbered about the pinion's own middle alone, and some of a
// gear near one end of it were missing.)
TEST(Slices, OfAGearFarFromThePinionsMiddleAreAllThere)
{
  const MeshDeviations none;
  for (const bool counter_clockwise : { false, true })
    {
      PairData data = paper_pair(25.232);
      data.counter_clockwise_drive = counter_clockwise;
      data.pinion.face_width = 400;
      data.gear.face_width = 20;
      const GearPair middle = make_gear_pair(data);
      const double axial_pitch = middle.transverse_base_pitch / std::tan(middle.base_helix_angle);
      for (const int pitches : { -8, -4, -1, 1, 4, 8 })
        {
          data.axial_offset = pitches * axial_pitch;
          const GearPair aside = make_gear_pair(data);
          const int back = static_cast<int>(canonical_z_sign(data)) * pitches;
          for (const double phase : { 0.0, 0.35, 0.7 })
            {
              const std::vector<Slice> there = MeshPosition(aside, none, phase).slices(20),
                                       here = MeshPosition(middle, none, phase).slices(20);
              ASSERT_EQ(there.size(), here.size()) << pitches << " pitches, phase " << phase;
              for (std::size_t s = 0; s < here.size(); ++s)
                {
                  EXPECT_EQ(there[s].pair + back, here[s].pair);
                  EXPECT_NEAR(there[s].pinion_roll, here[s].pinion_roll, 1e-9);
                  EXPECT_NEAR(there[s].touch, here[s].touch, 1e-9);
                }
            }
        }
    }
}
