// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace flank;

namespace
{
  /// Steel rollers of 10 mm radius, the second one longer by a factor.
  RollerPairData rollers(const double length, const double longer, const double poissons_ratio)
  {
    RollerPairData data;
    for (CrownedRoller *roller : { &data.first, &data.second })
      roller->radius = 10, roller->length = length, roller->youngs_modulus = 206e3,
      roller->poissons_ratio = poissons_ratio;
    data.second.length *= longer;
    data.free_ends = std::make_shared<const RollerEnds>(data.first, data.second);
    return data;
  }

  /// Greatest pressure across, by the distance from mid-length.
  std::map<double, double> along(const RollerPairContact &contact)
  {
    std::map<double, double> result;
    for (const PressedCell &cell : contact.cells)
      result[std::abs(cell.y)] = std::max(result[std::abs(cell.y)], cell.pressure);
    return result;
  }
} // namespace

// Without lateral contraction a roller that ends on both sides of a contact is as any slice of it: the
// pressure is that of a line contact up to the ends. (What is left, 1 %, is that each end counts as if it
// were alone.)
TEST(RollerEnds, WithoutPoissonsRatioEqualRollersAreSlices)
{
  const RollerPairData data = rollers(10, 1, 0);
  const RollerPairContact contact = press(data, { 32, 24 }, 5000);
  const double line = half_space::hertz_line(5, data.effective_modulus(), 500).max_pressure;
  for (const auto &[place, pressure] : along(contact))
    EXPECT_NEAR(pressure, line, 0.012 * line) << place;
  EXPECT_EQ(data.free_ends->pressure_exponent(), 0);
  EXPECT_EQ(contact.end_intensity, 0);
  RollerPairData half_space = data;
  half_space.free_ends = nullptr;
  EXPECT_GT(press(half_space, { 32, 24 }, 5000).edge_pressure, 1.3 * line);
}

// Steel: near the ends nothing keeps it from widening along the axes, and it yields more.
TEST(RollerEnds, EqualRollersPressLessAtTheirEnds)
{
  const auto pressure = along(press(rollers(2, 1, 0.3), { 24, 48 }, 1000));
  const double middle = pressure.begin()->second;
  double last = middle;
  for (const auto &[place, here] : pressure)
    {
      EXPECT_LT(here, last * (1 + 2e-3)) << place; // falls all the way
      last = here;
    }
  EXPECT_LT(last, 0.75 * middle);
  // A quarter of a contact's width from the ends no grid matters.
  const auto finer = along(press(rollers(2, 1, 0.3), { 24, 96 }, 1000));
  const auto at = [](const std::map<double, double> &of, const double place) {
    const auto above = of.lower_bound(place);
    const auto below = std::prev(above);
    return below->second +
           (place - below->first) / (above->first - below->first) * (above->second - below->second);
  };
  EXPECT_NEAR(at(pressure, 0.91), at(finer, 0.91), 0.012 * middle);
  EXPECT_NEAR(at(pressure, 0.5), at(finer, 0.5), 1e-3 * middle);
}

// On a longer roller the peak at the end grows as cells shrink; what it is the peak of, and the load, do not.
TEST(RollerEnds, OnALongerRollerTheEndsAreSingular)
{
  const RollerPairData data = rollers(2, 1.4, 0.3);
  EXPECT_NEAR(data.free_ends->pressure_exponent(), -0.2260, 1e-4);
  const RollerPairContact coarse = press(data, { 24, 48 }, 1000), fine = press(data, { 24, 96 }, 1000);
  EXPECT_GT(fine.edge_pressure, 1.1 * coarse.edge_pressure);
  EXPECT_NEAR(fine.end_intensity, coarse.end_intensity, 0.06 * fine.end_intensity);
  EXPECT_NEAR(fine.approach, coarse.approach, 1e-4 * fine.approach);
  EXPECT_NEAR(fine.max_pressure, coarse.max_pressure, 1e-3 * fine.max_pressure);
}

// Which roller is which, lengths in other units, and ends far away make no difference.
TEST(RollerEnds, Invariants)
{
  RollerPairData data = rollers(4, 1.5, 0.3);
  data.second.youngs_modulus = 100e3, data.second.poissons_ratio = 0.2;
  const RollerPairGrid grid{ 16, 24 };
  const auto pressed = [&](const CrownedRoller &first, const CrownedRoller &second, const double force) {
    RollerPairData other{ first, second };
    other.free_ends = std::make_shared<const RollerEnds>(first, second);
    return press(other, grid, force);
  };
  const RollerPairContact contact = pressed(data.first, data.second, 1000),
                          exchanged = pressed(data.second, data.first, 1000);
  EXPECT_NEAR(exchanged.approach, contact.approach, 1e-9 * contact.approach);
  EXPECT_NEAR(exchanged.edge_pressure, contact.edge_pressure, 1e-9 * contact.edge_pressure);
  CrownedRoller first = data.first, second = data.second;
  for (CrownedRoller *roller : { &first, &second })
    roller->radius *= 100, roller->length *= 100;
  const RollerPairContact larger = pressed(first, second, 1e4 * 1000);
  EXPECT_NEAR(larger.approach, 100 * contact.approach, 1e-9 * larger.approach);
  EXPECT_NEAR(larger.edge_pressure, contact.edge_pressure, 1e-9 * contact.edge_pressure);
  // A crowned contact in the middle of long rollers.
  first = data.first, second = data.second;
  first.crown_radius = 400;
  first.length = second.length = 300;
  RollerPairData far{ first, second };
  const RollerPairContact ends_away = pressed(first, second, 100), without = press(far, grid, 100);
  EXPECT_NEAR(ends_away.max_pressure, without.max_pressure, 2e-3 * without.max_pressure);
}
