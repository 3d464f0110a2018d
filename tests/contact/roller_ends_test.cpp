// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_contact.hpp"
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

  /// Force on what lies beyond a distance from mid-length. [N]
  double force_beyond(const RollerPairContact &contact, const double distance)
  {
    double sum = 0;
    for (const PressedCell &cell : contact.cells)
      {
        const double beyond = std::clamp(std::abs(cell.y) + cell.half_y - distance, 0.0, 2 * cell.half_y);
        sum += cell.pressure * 2 * cell.half_x * beyond;
      }
    return sum;
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
  // Half of a contact's width at both ends: a tenth of the length carries an eighth of the load.
  for (const double distance : { 0.9, 0.8 })
    EXPECT_NEAR(force_beyond(fine, distance), force_beyond(coarse, distance),
                0.01 * force_beyond(fine, distance))
        << force_beyond(fine, distance) << " N beyond " << distance;
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

namespace
{
  /// The same rollers as the pairs of a drive have them.
  RollerContactData of_drive(const RollerPairData &pair)
  {
    RollerContactData data;
    data.roller_radius = pair.first.radius, data.sleeve_radius = pair.second.radius;
    data.width = pair.first.length;
    data.roller_modulus = pair.first.youngs_modulus, data.sleeve_modulus = pair.second.youngs_modulus;
    data.roller_poisson = pair.first.poissons_ratio, data.sleeve_poisson = pair.second.poissons_ratio;
    data.free_ends = pair.free_ends;
    return data;
  }
} // namespace

// A drive's pair, whose cells shrink towards the ends, is the roller pair with equal ones: of unlike
// materials too. Without free ends, as with them.
TEST(RollerEnds, OfADrivesPairsAreThoseOfARollerPair)
{
  RollerPairData data = rollers(2, 1, 0.3);
  data.second.radius = 12;
  for (const bool unlike : { false, true })
    {
      if (unlike)
        data.second.youngs_modulus = 110e3, data.second.poissons_ratio = 0.2;
      for (const bool free : { false, true })
        {
          data.free_ends = free ? std::make_shared<const RollerEnds>(data.first, data.second) : nullptr;
          const RollerPairContact pair = press(data, { 32, 96 }, 1000);
          PressureMap map;
          const PairState state = PairLaw(of_drive(data), { 32, 96 }).solve(1000, &map);
          // Equal cells see less of the peaks that a half-space has at its ends.
          const double apart = free ? 2e-4 : 2e-3;
          EXPECT_NEAR(state.approach, pair.approach, apart * pair.approach) << unlike << free;
          EXPECT_NEAR(state.stiffness, pair.stiffness, 2 * apart * pair.stiffness) << unlike << free;
          const auto equal = along(pair);
          EXPECT_NEAR(state.mid_pressure, equal.begin()->second, 3e-3 * state.mid_pressure) << unlike << free;
          // At a place that both have cells about, a tenth of the length from the end.
          double graded = 0, least = 1;
          for (std::size_t k = 0; k < map.y.size(); ++k)
            if (const double from = std::abs(map.y[k] - 0.8); from < least + 1e-9)
              {
                graded = from < least - 1e-9 ? map.pressure[k] : std::max(graded, map.pressure[k]);
                least = std::min(least, from);
              }
          EXPECT_NEAR(graded, equal.lower_bound(0.79)->second, 0.01 * graded) << unlike << free;
        }
    }
}

// What a half-space has at the ends of straight rollers grows as cells shrink. To free ends that meet the
// pressure falls, further as cells tell it.
TEST(RollerEnds, OfADrivesPairsPressLessThere)
{
  RollerPairData data = rollers(10, 1, 0.3);
  const auto at = [&](const bool free, const int cells) {
    data.free_ends = free ? std::make_shared<const RollerEnds>(data.first, data.second) : nullptr;
    return PairLaw(of_drive(data), { 24, cells }).solve(5000);
  };
  const PairState coarse = at(false, 40), fine = at(false, 80), freely = at(true, 40), finer = at(true, 80);
  EXPECT_GT(fine.edge_pressure, 1.15 * coarse.edge_pressure);
  EXPECT_LT(freely.edge_pressure, freely.mid_pressure);
  EXPECT_LT(finer.edge_pressure, freely.edge_pressure);
  EXPECT_EQ(freely.max_pressure, freely.mid_pressure);
  EXPECT_NEAR(finer.approach, freely.approach, 1e-4 * freely.approach);
  EXPECT_GT(freely.approach, coarse.approach); // nothing holds the ends
}
