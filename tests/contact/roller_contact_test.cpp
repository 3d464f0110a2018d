// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/drive_position.hpp"
#include "mesh/base/units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

using namespace flank;
using units::pi;

namespace
{
  double effective_modulus(const RollerContactData &c)
  {
    return 1 / (pi * c.surface_compliance());
  }
} // namespace

TEST(PairLaw, StraightRollerIsHertzLineAtMidLength)
{
  RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  c.width = 40; // ends far away
  const PairLaw law(c, { 40, 60, false });
  const double F = 2000, w = F / c.width, R = c.relative_radius(), E = effective_modulus(c);
  PressureMap map;
  const auto s = law.solve(F, &map);
  double local = 0; // load per length at mid-length: the ends take more than their share
  for (std::size_t i = 0; i < map.x.size(); ++i)
    if (map.y[i] == map.y[0])
      local += 4 * map.half_x[i] * map.pressure[i];
  EXPECT_NEAR(local, w, 0.1 * w);
  EXPECT_NEAR(s.mid_pressure, std::sqrt(local * E / (pi * R)), 0.005 * s.mid_pressure); // 30 cells across
  EXPECT_GT(s.edge_pressure, 1.1 * s.mid_pressure);
}

TEST(PairLaw, FullyCrownedRollerIsHertzEllipse)
{
  // Crown so strong that the contact is an ellipse well inside the roller: approach and peak by elliptic
  // integrals.
  RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  c.crown_radius = 60;
  const double F = 50, Rx = c.relative_radius(), Ry = c.crown_radius, E = effective_modulus(c);
  const auto elliptic = [](const double m, double &K, double &Ei) {
    K = Ei = 0;
    for (int i = 0; i < 4000; ++i)
      {
        const double t = (i + 0.5) / 4000 * pi / 2, d = std::sqrt(1 - m * std::sin(t) * std::sin(t));
        K += pi / 8000 / d;
        Ei += pi / 8000 * d;
      }
  };
  double low = 1e-3, high = 1, K = 0, Ei = 0; // short over long axis; Johnson (1985) eq. 4.28
  for (int i = 0; i < 80; ++i)
    {
      const double k = 0.5 * (low + high);
      elliptic(1 - k * k, K, Ei);
      ((Ei / (k * k) - K) / (K - Ei) > Ry / Rx ? low : high) = k;
    }
  const double e2 = 1 - low * low;
  elliptic(e2, K, Ei);
  // long axis a: a^3 = 3 F Ry (K - E) / (pi E* e^2) ; p0 = 3F/(2 pi a b); approach = 3 F K / (2 pi a E*).
  const double a = std::cbrt(3 * F * Ry * (K - Ei) / (pi * E * e2)), b = low * a;
  PressureMap map;
  const auto s = PairLaw(c, { 40, 40, false }).solve(F, &map);
  EXPECT_NEAR(s.max_pressure, 3 * F / (2 * pi * a * b), 0.01 * s.max_pressure); // 30 cells across either axis
  EXPECT_NEAR(s.approach, 3 * F * K / (2 * pi * a * E), 0.003 * s.approach);
  EXPECT_EQ(s.edge_pressure, 0);
  const double middle = *std::min_element(map.y.begin(), map.y.end());
  double mid = 0; // of the cells beside mid-length alone
  for (std::size_t i = 0; i < map.y.size(); ++i)
    if (map.y[i] == middle)
      mid = std::max(mid, map.pressure[i]);
  EXPECT_EQ(s.mid_pressure, mid);
}

TEST(PairLaw, BetweenItsNodesItIsTheSolutionThere)
{
  const RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  const PairLaw law(c, { 20, 40, false });
  for (const double force : { 11.0, 97.0, 333.0, 2900.0 })
    {
      const PairState direct = law.solve(force), between = law.at_approach(direct.approach);
      // The grid follows the load in every solve: 1e-4 is the ripple of its cells against the contact's edge.
      EXPECT_NEAR(between.force, force, 2.5e-4 * force); // 1.1 to 1.2 times as much as of the approach
      EXPECT_NEAR(between.mid_pressure, direct.mid_pressure, 0.01 * direct.mid_pressure);
    }
}

TEST(PairLaw, MidRollerPeakAndLoadConvergeWithTheGrid)
{
  const RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  std::vector<double> force, mid, edge;
  for (const int level : { 0, 1, 2 })
    {
      const PairLaw law(c, { std::array{ 10, 20, 40 }[level], std::array{ 20, 40, 80 }[level], false });
      const PairState s = law.at_approach(0.002);
      force.push_back(s.force);
      mid.push_back(s.mid_pressure);
      edge.push_back(s.edge_pressure);
    }
  EXPECT_NEAR(force[1], force[2], 1e-3 * force[2]);
  EXPECT_LT(std::abs(force[1] - force[2]), std::abs(force[0] - force[2]));
  EXPECT_NEAR(mid[1], mid[2], 0.01 * mid[2]);
  EXPECT_GT(edge[2], 1.05 * edge[1]); // the singular end: it grows with the cells, as the results say
}

TEST(PairLaws, BetweenTwoRadiiStiffnessIsTheSlopeOfTheForce)
{
  // The relative radius lies a fifth and four fifths of the way from one rung to the next: weights exchanged
  // change the stiffness by 1e-3.
  RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  c.crown_radius = 150; // the exponent of its law depends on the radius
  const PairLaws laws(c, { 20, 20, false });
  for (const double part : { 0.2, 0.8 })
    {
      const double radius = 1 / (std::pow(1.1, -(3 + part)) - 1 / c.roller_radius), approach = 0.004,
                   step = 1e-4 * approach;
      const double slope =
          (laws.load_at(radius, approach + step).force - laws.load_at(radius, approach - step).force) /
          (2 * step);
      EXPECT_NEAR(laws.at_approach(radius, approach).stiffness, slope, 1e-6 * slope)
          << part; // the differences' error is 1e-8
    }
}

// Cells of a prescribed grid touch at their own gap, of one radius before that of the next: between them the
// law is linear. (Its stiffness was once not a number there.)
TEST(PairLaws, OfAPrescribedGridHaveASlopeWhereOneOfTwoRadiiDoesNotTouch)
{
  const RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  RollerGridSize grid{ 20, 8, false };
  grid.half_width = 0.1;
  const PairLaws laws(c, grid);
  int idle = 0, loaded = 0, corners = 0; // where another cell begins to touch, the slope jumps
  for (double approach = 2e-6; approach < 1e-5; approach *= 1.02)
    {
      const double radius = -6, step = 1e-3 * approach, low = laws.load_at(radius, approach - step).force,
                   high = laws.load_at(radius, approach + step).force, slope = (high - low) / (2 * step);
      const PairState state = laws.at_approach(radius, approach);
      ASSERT_TRUE(std::isfinite(state.stiffness)) << approach;
      idle += high == 0;
      loaded += low > 0;
      corners += std::abs(state.stiffness - slope) > 1e-3 * slope;
    }
  EXPECT_GT(idle, 10);
  EXPECT_GT(loaded, 10);
  EXPECT_LE(corners, 4);
}

// The map of a pair on a prescribed grid is of its cells, and its pressures are those of the pair.
TEST(PairLaws, MapOfAPrescribedGridHasItsCellsAndPressures)
{
  const RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  RollerGridSize grid{ 20, 8, false };
  grid.half_width = 0.12;
  const PairLaws laws(c, grid);
  const PairState state = laws.at_approach(c.sleeve_radius, 0.002);
  const PressureMap map = laws.map(c.sleeve_radius, state.force);
  double force = 0, greatest = 0;
  for (std::size_t i = 0; i < map.x.size(); ++i)
    {
      EXPECT_NEAR(map.half_x[i], 0.006, 1e-12);
      force += 16 * map.half_x[i] * map.half_y[i] * map.pressure[i];
      greatest = std::max(greatest, map.pressure[i]);
    }
  EXPECT_NEAR(force, state.force, 1e-9 * state.force);
  EXPECT_NEAR(greatest, state.max_pressure, 1e-9 * greatest);
}

// To the last bit, whatever was asked for before: ranks and threads ask in other orders.
TEST(PairLaws, OfAPrescribedGridDoNotKnowTheOrderOfQuestions)
{
  const RollerContactData c{ 2.5, 3, 10, 206e3, 0.3, 206e3, 0.3 };
  RollerGridSize grid{ 20, 8, false };
  grid.half_width = 0.12;
  std::vector<double> approaches;
  for (double approach = 1e-7; approach < 3e-3; approach *= 1.7)
    approaches.push_back(approach);
  const auto asked = [&](const auto first, const auto last) {
    const PairLaws laws(c, grid);
    std::map<double, double> forces;
    for (auto at = first; at != last; ++at)
      forces[*at] = laws.load_at(-6, *at).force;
    return forces;
  };
  EXPECT_EQ(asked(approaches.begin(), approaches.end()), asked(approaches.rbegin(), approaches.rend()));
}
