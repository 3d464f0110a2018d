// SPDX-License-Identifier: GPL-2.0-or-later
// Contact grids at tip edges: cells end there, narrow towards it and resolve the force on it.
#include "contact/loaded/load_distribution.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

using namespace flank;

TEST(Grid, CellsEndAtASharpTipEdgeAndNarrowTowardsIt)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const MeshDeviations none;
  int ending[2] = { 0, 0 }; // at the pinion's tip, at the gear's
  for (const double phase : { 0.0, 0.06, 0.1, 0.14, 0.5, 0.86, 0.9, 0.94 })
    {
      const MeshPosition position(pair, none, phase);
      for (const Slice &slice : position.slices(5))
        for (const double half_width : { 0.03, 0.2, 0.6 })
          for (const double middle : { 0.0, 0.4 * half_width, -0.4 * half_width })
            for (const int across : { 11, 101 })
              {
                std::vector<ContactCell> cells;
                position.add_cells(slice, 0, middle, half_width, across, cells);
                const double rb = pair.pinion.base_radius, usual = 2 * half_width / across,
                             to_pinion = profile_length(slice.pinion_roll, pair.pinion.tip_roll, rb),
                             to_gear = profile_length(slice.gear_roll, pair.gear.tip_roll, rb),
                             low = std::max(middle - half_width, -to_gear),
                             high = std::min(middle + half_width, to_pinion);
                const bool at_pinion = high<middle + half_width, at_gear = low> middle - half_width;
                double covered = 0, last = -1e9;
                for (const ContactCell &cell : cells)
                  {
                    const double along = profile_length(slice.pinion_roll, cell.pinion.roll, rb);
                    EXPECT_GT(along, last);
                    last = along;
                    covered += 2 * cell.pinion.half_profile;
                    EXPECT_LT(2 * cell.pinion.half_profile, 1.126 * usual);
                    const bool ends_here =
                        (at_pinion && &cell == &cells.back()) || (at_gear && &cell == &cells.front());
                    EXPECT_EQ(cell.cut_short, ends_here || slice.tip_edge);
                    EXPECT_FALSE(ends_here && cell.window_border);
                  }
                if (slice.pinion_roll - 1e-2 > pair.pinion.form_roll &&
                    slice.gear_roll - 1e-2 > pair.gear.form_roll)
                  EXPECT_NEAR(covered, std::max(0.0, high - low), 0.02 * usual + 1e-9);
                if (!cells.empty() && at_pinion != at_gear)
                  {
                    ++ending[at_gear];
                    const double outermost =
                        2 * (at_pinion ? cells.back() : cells.front()).pinion.half_profile;
                    EXPECT_LT(outermost, 1.01 * usual);
                    if (slice.tip_edge && middle == 0)
                      EXPECT_LT(outermost, 0.51 * usual / across);
                  }
              }
    }
  EXPECT_GT(ending[0], 100);
  EXPECT_GT(ending[1], 100);
}

TEST(Grid, ResolvesTheForceOnATipEdge)
{
  // Beyond the path of action, on either side of it, the tip edge carries on a small part of its window: four
  // times as many cells change the transmission error there by less than 0.05 % (equal cells: 0.08 %), and
  // by less than 0.0005 the share of a pair that has just begun to touch (0.001).
  const GearPair pair = make_gear_pair(paper_pair(0));
  const BodyCompliance &body = small_body(0);
  const MeshDeviations none;
  int at_edges = 0;
  for (const double phase : { 0.07, 0.1, 0.13, 0.87, 0.9, 0.93 })
    for (const double torque : { 75e3, 300e3 })
      {
        const auto solved = [&](const int profile_cells) {
          return small_loaded_pair(pair, body, body, none, { 5, profile_cells }).solve(phase, { torque })[0];
        };
        const PositionResult usual = solved(11), fine = solved(45);
        EXPECT_NEAR(usual.theta / fine.theta, 1, 5e-4) << phase << " " << torque;
        if (fine.tip_edge_load == 0)
          continue;
        ++at_edges;
        ASSERT_EQ(usual.pairs.size(), fine.pairs.size());
        for (std::size_t i = 0; i < fine.pairs.size(); ++i)
          EXPECT_NEAR(load_share(usual, usual.pairs[i]), load_share(fine, fine.pairs[i]), 5e-4)
              << phase << " " << torque;
      }
  EXPECT_GE(at_edges, 6);
}
