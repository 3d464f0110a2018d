// SPDX-License-Identifier: GPL-2.0-or-later
// Hertz's closed forms against their defining equations; the numerical contact of two rollers against Hertz,
// against the drive's own quarter problem, and against itself: exchanged, turned, in other units.
#include "contact/rollers/roller_contact.hpp"
#include "contact/rollers/roller_pair.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace flank;
using units::pi;

namespace
{
  CrownedRoller roller(const double radius, const double length, const double crown,
                       const double straight = 0)
  {
    return { .radius = radius,
             .length = length,
             .crown_radius = crown,
             .straight_length = straight,
             .youngs_modulus = 206e3,
             .poissons_ratio = 0.3 };
  }

  RollerPairData pair(const CrownedRoller &first, const CrownedRoller &second, const double degrees = 0)
  {
    return { .first = first, .second = second, .crossing_angle = degrees * units::degree };
  }

  double off(const double value, const double reference)
  {
    return std::abs(value / reference - 1);
  }
} // namespace

// A short straight roller on a crowned one whose contact is long across the roller: it ends at both faces of
// the short roller, and their peaks stand apart, whatever the grid.
TEST(RollerPair, EndsAcrossTheContactAreEndsToo)
{
  const RollerPairData data = pair(roller(75.37, 0.4345, 0), roller(744.5, 1.983, 9.5));
  double before = 0;
  for (const int across : { 16, 32, 64 })
    {
      const RollerPairContact contact = press(data, { .across = across, .along = 32 }, 1000);
      EXPECT_LT(std::max(contact.width, contact.length), 150); // [mm]
      EXPECT_GT(contact.edge_pressure, 1.2 * contact.max_pressure) << across;
      // Hertz without ends is 1724 MPa; inside, the middle of the contact is near it and does not grow.
      EXPECT_LT(off(contact.max_pressure, 1750), 0.02) << across;
      EXPECT_GT(contact.edge_pressure, before) << across;
      before = contact.edge_pressure;
    }
}

// Where a short roller crosses a long one at a slant, a contact wider than the short roller is long ends at
// its faces farther from the middle than along the line through it.
TEST(RollerPair, AContactThatEndsAtASlantIsFound)
{
  const auto pressed = [](const double length, const int across) {
    return press(pair(roller(12, 20, 400), roller(9, length, 300), 45),
                 { .across = across, .along = 3 * across / 2 }, 1000);
  };
  for (const double length : { 0.5, 0.7, 1.0 })
    EXPECT_LT(off(pressed(length, 24).approach, pressed(length, 48).approach), 0.01) << length;
  EXPECT_GT(pressed(0.5, 24).approach, 1.05 * pressed(1, 24).approach);
}

TEST(RollerPair, ParallelIsParallelEitherWayRound)
{
  RollerPairData data = pair(roller(12, 20, 0), roller(9, 20, 0));
  for (const double degrees : { 0.0, 180.0, -180.0, 360.0 })
    {
      data.crossing_angle = degrees * units::degree;
      EXPECT_TRUE(hertz(data, 1000).line) << degrees;
    }
  // An ellipse longer than the rollers is no contact of theirs.
  data.crossing_angle = 1e-4 * units::degree;
  EXPECT_FALSE(hertz(data, 1000).ellipse);
  data.crossing_angle = 90 * units::degree;
  EXPECT_TRUE(hertz(data, 1000).ellipse);
}

// Below the surface Poisson's ratio counts: of two materials the stress is that of the roller where it is
// greater, whichever is named first. The pressures are the same for all, by the same effective modulus.
TEST(RollerPair, StressBelowTheSurfaceIsThatOfTheRollerWhereItIsGreater)
{
  const auto of = [](const double nu_first, const double nu_second) {
    RollerPairData data = pair(roller(8, 12, 1500), roller(25, 40, 0));
    data.first.poissons_ratio = nu_first;
    data.second.poissons_ratio = nu_second;
    data.first.youngs_modulus = 200e3 * (1 - nu_first * nu_first);
    data.second.youngs_modulus = 200e3 * (1 - nu_second * nu_second);
    return below_greatest_pressure(data, press(data, { .across = 24, .along = 32 }, 100));
  };
  const auto low = of(0.05, 0.05), high = of(0.45, 0.45), mixed = of(0.05, 0.45), exchanged = of(0.45, 0.05);
  EXPECT_GT(off(low.shear, high.shear), 0.01);
  EXPECT_GT(off(low.von_mises, high.von_mises), 0.01);
  for (const auto &both : { mixed, exchanged })
    {
      EXPECT_LT(off(both.shear, std::max(low.shear, high.shear)), 1e-9);
      EXPECT_LT(off(both.von_mises, std::max(low.von_mises, high.von_mises)), 1e-9);
    }
}

TEST(RollerPair, AContactLargerThanTheRollersIsSaid)
{
  RollerPairData data = pair(roller(12, 1, 0), roller(30, 8, 0), 40);
  data.first.youngs_modulus = data.second.youngs_modulus = 3e3;
  EXPECT_THROW(press(data, {}, 1e6), ComputationError);
}

TEST(Hertz, EllipseSolvesItsEquations)
{
  // Johnson (1985), equations 4.25, 4.26 and 4.28 with K and E of the standard library.
  for (const double ratio : { 1.7, 5.0, 40.0, 3e3, 1e6 })
    {
      const double modulus = 113e3, force = 250, least = 0.02 / ratio, greatest = 0.02;
      const auto h = half_space::hertz_ellipse(least, greatest, modulus, force);
      const double a = h.long_half_axis, b = h.short_half_axis, m = 1 - b * b / (a * a), e = std::sqrt(m);
      const double k = std::comp_ellint_1(e), second = std::comp_ellint_2(e), p0 = h.max_pressure;
      EXPECT_LT(off(p0, 1.5 * force / (pi * a * b)), 1e-12) << ratio;
      EXPECT_LT(off(least / 2, p0 / modulus * b / (m * a * a) * (k - second)), 1e-9) << ratio;
      EXPECT_LT(off(greatest / 2, p0 / modulus * b / (m * a * a) * (a * a / (b * b) * second - k)), 1e-9)
          << ratio;
      EXPECT_LT(off(h.approach, p0 / modulus * b * k), 1e-9)
          << ratio; // K of a thin ellipse loses digits in 1 - e^2
      const auto more = half_space::hertz_ellipse(least, greatest, modulus, force * 1.0001),
                 less = half_space::hertz_ellipse(least, greatest, modulus, force * 0.9999);
      EXPECT_LT(off(h.stiffness, 2e-4 * force / (more.approach - less.approach)), 1e-7) << ratio;
    }
}

TEST(Hertz, EqualCurvaturesGiveTheCircle)
{
  for (const double excess : { 0.0, 1e-12, 1e-9 })
    {
      const double radius = 12, modulus = 100e3, force = 80;
      const auto h = half_space::hertz_ellipse(1 / radius, (1 + excess) / radius, modulus, force);
      const double a = std::cbrt(0.75 * force * radius / modulus);
      EXPECT_LT(off(h.long_half_axis, a), 1e-8);
      EXPECT_LT(off(h.short_half_axis, a), 1e-8);
      EXPECT_LT(off(h.approach, a * a / radius), 1e-8);
    }
}

TEST(RollerPair, CurvaturesOfCrossedRollersFollowJohnson)
{
  // Johnson (1985), 4.5: A + B and B - A by the four curvatures and the angle; the contact's long axis lies
  // between the axes.
  const double angle = 35;
  const RollerPairData data = pair(roller(20, 30, 400), roller(9, 40, 150), angle);
  const auto c = data.curvatures();
  const double sum = 1 / 20.0 + 1 / 400.0 + 1 / 9.0 + 1 / 150.0, d1 = 1 / 20.0 - 1 / 400.0,
               d2 = 1 / 9.0 - 1 / 150.0;
  EXPECT_LT(off(c.least + c.greatest, sum), 1e-12);
  EXPECT_LT(off(c.greatest - c.least,
                std::sqrt(d1 * d1 + d2 * d2 + 2 * d1 * d2 * std::cos(2 * angle * units::degree))),
            1e-12);
  EXPECT_GT(c.direction, 0);
  EXPECT_LT(c.direction, angle * units::degree);
}

TEST(RollerPair, AgreesWithHertzWhereTheContactIsSmall)
{
  // Cells of 1/16 of the contact's half-width: their mean of the greatest pressure is 0.1 % below it, the
  // approach hangs on them less.
  for (const RollerPairData &data :
       { pair(roller(20, 30, 0), roller(20, 30, 0), 90), pair(roller(20, 30, 0), roller(12, 30, 0), 40),
         pair(roller(20, 30, 200), roller(12, 30, 90)), pair(roller(20, 30, 200), roller(12, 30, 90), 12),
         pair(roller(20, 30, 0), roller(12, 30, 400), -55) })
    for (const double force : { 0.5, 30.0 })
      {
        const RollerPairContact contact = press(data, {}, force);
        const auto h = hertz(data, force).ellipse;
        ASSERT_TRUE(h);
        EXPECT_LT(off(contact.approach, h->approach), 1e-3) << force;
        // The tangent holds the loaded cells, and so the contact's border, in steps of a cell: 0.4 to 0.5 %
        // here, half of that below.
        EXPECT_LT(off(contact.stiffness, h->stiffness), 6e-3) << force;
        EXPECT_LT(off(press(data, { .across = 64, .along = 96 }, force).stiffness, h->stiffness), 3e-3)
            << force;
        EXPECT_LT(off(contact.max_pressure, h->max_pressure), 5e-3) << force;
        EXPECT_LT(off(contact.width, 2 * h->short_half_axis), 0.1) << force; // a cell on either side
        EXPECT_LT(off(contact.length, 2 * h->long_half_axis), 0.1) << force;
        EXPECT_EQ(contact.edge_pressure, 0);
        double sum = 0;
        for (const PressedCell &cell : contact.cells)
          sum += cell.pressure * 4 * cell.half_x * cell.half_y;
        EXPECT_LT(off(sum, force), 1e-9);
        EXPECT_LT(contact.certificate.worst(), 1e-10);
      }
}

TEST(RollerPair, DeepStressesUnderACircleAreHuber)
{
  // Johnson (1985), 3.4: nu = 0.3, greatest shear 0.31 p0 at 0.48 a below the middle.
  const RollerPairData data = pair(roller(20, 30, 0), roller(20, 30, 0), 90);
  const RollerPairContact contact = press(data, { .across = 32, .along = 32 }, 20);
  const auto h = hertz(data, 20).ellipse;
  const half_space::SubsurfaceStress below = below_greatest_pressure(data, contact);
  EXPECT_NEAR(below.shear / h->max_pressure, 0.310, 0.002);
  EXPECT_NEAR(below.shear_depth / h->long_half_axis, 0.48, 0.01);
}

TEST(RollerPair, StraightRollersGiveTheLineInTheMiddle)
{
  const RollerPairData data = pair(roller(15, 60, 0), roller(10, 40, 0));
  const RollerPairContact contact = press(data, {}, 4000);
  const auto line = hertz(data, 4000).line;
  ASSERT_TRUE(line);
  EXPECT_FALSE(hertz(data, 4000).ellipse);
  double middle = 0;
  for (const PressedCell &cell : contact.cells)
    if (std::abs(cell.y) < cell.half_y * 1.01)
      middle = std::max(middle, cell.pressure);
  // The ends carry more than their share, by 1/ln of length over width: 3 % are missing in the middle. The
  // drive's code, whose cells shrink towards the ends, finds the same.
  RollerContactData drive;
  drive.roller_radius = 15, drive.sleeve_radius = 10, drive.width = 40;
  drive.roller_modulus = drive.sleeve_modulus = 206e3;
  drive.roller_poisson = drive.sleeve_poisson = 0.3;
  EXPECT_LT(off(middle, PairLaw(drive, { .across = 40, .along = 60 }).solve(4000).mid_pressure), 5e-3);
  EXPECT_NEAR(middle / line->max_pressure, 0.97, 0.01);
  EXPECT_NEAR(contact.length, 40, 1e-9);
  EXPECT_GT(contact.edge_pressure, line->max_pressure);
}

// Where the ends carry most, pressure and stresses are those of the middle: the grid does not matter, and
// they are near Hertz's line. (Beside the ends 496, 519, 537, 555 MPa with 16 to 192 cells: so they once
// were.)
TEST(RollerPair, PressureOfStraightRollersDoesNotDependOnTheGrid)
{
  const RollerPairData data = pair(roller(10, 30, 0), roller(10, 30, 0));
  const auto line = hertz(data, 1000);
  for (const int along : { 16, 48, 96 })
    {
      const RollerPairContact contact = press(data, { .across = 32, .along = along }, 1000);
      const half_space::SubsurfaceStress below = below_greatest_pressure(data, contact);
      EXPECT_LT(off(contact.max_pressure, 475), 5e-3) << along; // the ends take 3 % off the line's 490
      EXPECT_LT(off(below.shear / contact.max_pressure, line.subsurface->shear / line.line->max_pressure),
                0.01)
          << along;
      EXPECT_LT(
          off(below.von_mises / contact.max_pressure, line.subsurface->von_mises / line.line->max_pressure),
          0.01)
          << along;
    }
}

// A peak where a crown begins is the rollers' own, also where their ends carry more; a mere rise towards the
// ends is not, and ends in the middle. Neither depends on the grid.
TEST(RollerPair, APeakInsideIsNotTakenForTheRiseTowardsAnEnd)
{
  struct Scene
  {
    double crown_radius, force;
    bool has_peak;
  };
  for (const Scene &scene : { Scene{ 2000, 60000, true }, Scene{ 20000, 24000, false } })
    {
      double before = 0;
      for (const int along : { 48, 96 })
        {
          const RollerPairContact contact =
              press(pair(roller(10, 30, scene.crown_radius, 10), roller(10, 30, 0)),
                    { .across = 32, .along = along }, scene.force);
          double middle = 0;
          for (const PressedCell &cell : contact.cells)
            if (std::abs(cell.y) < 1.01 * cell.half_y)
              middle = std::max(middle, cell.pressure);
          EXPECT_GT(contact.edge_pressure, contact.max_pressure) << along;
          if (scene.has_peak)
            EXPECT_GT(contact.max_pressure, 1.015 * middle) << along;
          else
            EXPECT_LT(off(contact.max_pressure, middle), 1e-3) << along;
          if (before > 0)
            {
              EXPECT_LT(off(contact.max_pressure, before), 5e-3) << scene.force;
            }
          before = contact.max_pressure;
        }
    }
}

TEST(RollerPair, AgreesWithTheDrivesQuarterProblem)
{
  // The same contact by another grid, cells and code: parallel rollers of equal length, one of them crowned.
  RollerContactData drive;
  drive.roller_radius = 8, drive.sleeve_radius = 11, drive.width = 20;
  drive.roller_modulus = drive.sleeve_modulus = 206e3;
  drive.roller_poisson = drive.sleeve_poisson = 0.3;
  drive.crown_radius = 3000;
  for (const double straight : { 0.0, 8.0 })
    for (const double force : { 50.0, 2000.0 })
      {
        drive.straight_length = straight;
        const PairState other = PairLaw(drive, { .across = 40, .along = 60 }).solve(force);
        const RollerPairContact contact =
            press(pair(roller(8, 20, 3000, straight), roller(11, 20, 0)), {}, force);
        EXPECT_LT(off(contact.approach, other.approach), 1e-3) << straight << " " << force;
        EXPECT_LT(off(contact.stiffness, other.stiffness), 5e-3) << straight << " " << force;
        EXPECT_LT(off(contact.max_pressure, other.max_pressure), 1e-2) << straight << " " << force;
      }
}

TEST(RollerPair, DoesNotDependOnTheOrderTheTurnOrTheUnits)
{
  const RollerPairData data = pair(roller(20, 12, 3000, 2), roller(7, 30, 0), 0.5);
  const double force = 4000;
  const RollerPairContact one = press(data, {}, force);
  EXPECT_GT(one.edge_pressure, 0); // the case reaches the ends
  const auto same = [&](const RollerPairContact &other, const double tolerance, const char *what) {
    EXPECT_LT(off(other.approach, one.approach), tolerance) << what;
    EXPECT_LT(off(other.stiffness, one.stiffness), tolerance) << what;
    EXPECT_LT(off(other.max_pressure, one.max_pressure), tolerance) << what;
    EXPECT_LT(off(other.edge_pressure, one.edge_pressure), tolerance) << what;
    EXPECT_LT(
        off(below_greatest_pressure(data, other).von_mises, below_greatest_pressure(data, one).von_mises),
        1e-7)
        << what; // Brent's method ends before rounding
  };
  same(press(pair(data.second, data.first, -0.5), {}, force), 1e-9, "exchanged, seen from the other side");
  same(press(pair(data.first, data.second, -0.5), {}, force), 1e-9, "mirrored");
  same(press(pair(data.first, data.second, 179.5), {}, force), 1e-9,
       "a cylinder turned about its middle"); // and mirrored
  same(press(pair(data.first, data.second, 180.5), {}, force), 1e-9, "turned by half a turn");
  auto larger = data;
  for (CrownedRoller *r : { &larger.first, &larger.second })
    for (double *length : { &r->radius, &r->length, &r->crown_radius, &r->straight_length })
      *length *= 10;
  RollerPairContact scaled = press(larger, {}, 100 * force);
  scaled.approach /= 10;
  scaled.stiffness /= 10;
  same(scaled, 1e-9, "ten times as large");
}

TEST(RollerPair, ApproachGrowsAndItsSlopeIsTheStiffness)
{
  const RollerPairData data = pair(roller(20, 12, 300), roller(7, 30, 0), 1);
  double before = 0;
  for (const double force : { 1e-3, 1.0, 40.0, 900.0, 6000.0 })
    {
      const auto at = press(data, {}, force), more = press(data, {}, 1.02 * force),
                 less = press(data, {}, 0.98 * force);
      EXPECT_GT(at.approach, before);
      before = at.approach;
      // Neighbours may stand on other grids, which moves the approach by up to 2e-5 of itself: 0.1 % of 4 %
      // of it.
      EXPECT_LT(off(at.stiffness, 0.04 * force / (more.approach - less.approach)), 0.01) << force;
    }
  EXPECT_EQ(press(data, {}, 0).approach, 0);
  EXPECT_TRUE(press(data, {}, 0).cells.empty());
}

TEST(RollerPair, RefusesAContactThatIsNoHalfSpace)
{
  EXPECT_THROW(press(pair(roller(1, 1, 0), roller(1, 1, 0)), {}, 1e6), ComputationError);
}
