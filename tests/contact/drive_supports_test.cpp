// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and bearings of the drive: their laws against beam theory and ISO/TS 16281's sums, and the drive on
// them against equilibrium put together here from distances of centres alone.
#include "cases/double_roller/results.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/drive_cases.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numeric>

using namespace flank;
using units::degree;
using units::pi;

namespace
{
  /// Twice the energy of a beam under a unit force spread evenly over it: the mean deflection.
  double by_energy(const PinData &pin, const std::function<double(double)> &moment,
                   const std::function<double(double)> &shear_force)
  {
    const double r = pin.diameter / 2, bending = pin.youngs_modulus * pi / 4 * std::pow(r, 4),
                 nu = pin.poissons_ratio, kappa = 6 * (1 + nu) / (7 + 6 * nu),
                 shear = kappa * pin.youngs_modulus / (2 * (1 + nu)) * pi * r * r;
    const GaussRule &rule = gauss(4);
    double sum = 0;
    for (std::size_t q = 0; q < rule.point.size(); ++q)
      {
        const double x = pin.free_length * rule.point[q], m = moment(x), v = shear_force(x);
        sum += rule.weight[q] * pin.free_length * (m * m / bending + v * v / shear);
      }
    return sum;
  }

  std::vector<std::string> soft(const std::vector<std::string> &more = {})
  {
    std::vector<std::string> settings = { "drive.uniform_clearance_um=3",
                                          "drive.pins.type=\"cantilever\"",
                                          "drive.pins.diameter_mm=4",
                                          "drive.carrier_bearing.type=\"spring\"",
                                          "drive.carrier_bearing.stiffness_N_per_um=[400, 30, 300]",
                                          "drive.crank_bearing.type=\"rollers\"",
                                          "drive.crank_bearing.elements=14",
                                          "drive.crank_bearing.element_length_mm=6" };
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
  }

  Eigen::Vector2d displacement(const SupportLoad &support)
  {
    return { support.displacement_x, support.displacement_y };
  }

  Eigen::Vector2d force(const SupportLoad &support)
  {
    return { support.force_x, support.force_y };
  }
} // namespace

TEST(Pins, DeflectAsBeamTheoryHasIt)
{
  PinData pin{ .held = PinData::Held::one_end,
               .diameter = 4,
               .free_length = 10,
               .youngs_modulus = 206e3,
               .poissons_ratio = 0.3 };
  const double l = pin.free_length;
  EXPECT_NEAR(pin.compliance(),
              by_energy(
                  pin, [&](const double x) { return (l - x) * (l - x) / (2 * l); },
                  [&](const double x) { return (l - x) / l; }),
              1e-12 * pin.compliance());
  pin.held = PinData::Held::both_ends;
  EXPECT_NEAR(pin.compliance(),
              by_energy(
                  pin, [&](const double x) { return l / 12 - x / 2 + x * x / (2 * l); },
                  [&](const double x) { return 0.5 - x / l; }),
              1e-12 * pin.compliance());
}

// The most loaded of many elements without clearance carries 4.08 F/Z (line contact) or 4.37 F/Z (point
// contact): Harris, Rolling Bearing Analysis.
TEST(Bearings, LoadTheirElementsAsTheSumsOfTheLiterature)
{
  for (const auto &[exponent, most] : { std::pair{ 10.0 / 9, 4.08 }, { 1.5, 4.37 } })
    {
      const Bearing bearing{ .elements = 200, .constant = 1e5, .exponent = exponent };
      const Eigen::Vector2d at(0.01, 0);
      const double carried = bearing.force(at).x(), greatest = 1e5 * std::pow(0.01, exponent);
      EXPECT_NEAR(greatest * bearing.elements / carried, most, 0.01);
      EXPECT_NEAR(bearing.force(at).y(), 0, 1e-9 * carried);
    }
}

TEST(Bearings, TangentIsTheForcesDerivative)
{
  Bearing bearing{ .elements = 9, .constant = 3e4, .exponent = 1.5, .clearance = 0.004 };
  bearing.stiffness << 2e4, 3e3, 3e3, 1e4;
  const Eigen::Vector2d at(0.007, -0.012);
  for (int axis = 0; axis < 2; ++axis)
    {
      const Eigen::Vector2d off = 1e-7 * Eigen::Vector2d::Unit(axis),
                            by_difference = (bearing.force(at + off) - bearing.force(at - off)) / 2e-7;
      EXPECT_LT((bearing.tangent(at).col(axis) - by_difference).norm(), 1e-6 * by_difference.norm());
    }
  bearing.stiffness.setZero();
  EXPECT_EQ(bearing.force({ 0.0019, 0 }).norm(), 0); // within half of its clearance, and beyond
  EXPECT_NEAR(bearing.force({ 0.0021, 0 }).x(), 3e4 * std::pow(1e-4, 1.5), 1e-9);
}

namespace
{
  /// Every force from where the parts stand: the pairs' by their distances, the pins' and bearings' by their
  /// own displacements.
  void expect_equilibrium(const DoubleRollerCase &input, const std::vector<double> &torques)
  {
    const LoadedDrive drive(input);
    const auto &d = input.drive;
    for (const double angle : { 0.0, 7.3, 31.0 })
      for (const double torque : torques)
        {
          const DrivePosition p = drive.solve(angle * degree, torque);
          std::vector<Eigen::Vector2d> pins(static_cast<std::size_t>(d.rollers), Eigen::Vector2d::Zero()),
              on_pins = pins;
          Eigen::Vector2d bearings(0, 0), on_bearings(0, 0);
          for (const SupportLoad &s : p.supports)
            if (is_of_sleeve(s.part))
              pins[static_cast<std::size_t>(s.sleeve)] += displacement(s);
            else
              bearings += displacement(s);
          // Centres by the drive's definition: phi counter-clockwise, the carrier clockwise by psi.
          const auto sleeve_at = [&](const int n, const double psi) -> Eigen::Vector2d {
            const double at = 2 * pi / (d.rollers - 1) * (n - 0.5) - psi;
            return Eigen::Vector2d(
                       d.eccentricity * std::cos(p.crank_angle) + d.sleeve_circle_radius * std::cos(at),
                       d.eccentricity * std::sin(p.crank_angle) + d.sleeve_circle_radius * std::sin(at)) +
                   bearings + pins[static_cast<std::size_t>(n)];
          };
          double moment = 0, greatest = 0;
          std::size_t closed = 0;
          for (int n = 1; n < d.rollers; ++n)
            for (int k = 1; k <= d.rollers; ++k)
              {
                const double at = 2 * pi / d.rollers * k;
                const Eigen::Vector2d roller(d.roller_circle_radius * std::cos(at),
                                             d.roller_circle_radius * std::sin(at)),
                    apart = sleeve_at(n, p.psi) - roller;
                const double gap = apart.norm() - d.roller_radius - d.sleeve_radius + d.clearance;
                if (gap >= -1e-12)
                  continue;
                ++closed;
                const double carried = drive.laws().load_at(input.contact.sleeve_radius, -gap).force,
                             lever = ((sleeve_at(n, p.psi + 1e-6) - roller).norm() -
                                      (sleeve_at(n, p.psi - 1e-6) - roller).norm()) /
                                     2e-6;
                moment += lever * carried;
                greatest = std::max(greatest, carried);
                on_pins[static_cast<std::size_t>(n)] += carried * apart.normalized();
                on_bearings += carried * apart.normalized();
              }
          EXPECT_EQ(closed, p.pairs.size());
          EXPECT_NEAR(moment, torque, 1e-7 * std::max(torque, greatest)); // distances in double precision
          for (const SupportLoad &s : p.supports)
            {
              const Eigen::Vector2d on = is_of_sleeve(s.part) ? on_pins[static_cast<std::size_t>(s.sleeve)]
                                                              : on_bearings,
                                    by = input.supports.elastic.at(s.part).force(displacement(s));
              EXPECT_LE((force(s) - on).norm(), 1e-7 * greatest);
              EXPECT_LE((by - on).norm(), 1e-7 * greatest);
            }
        }
  }
} // namespace

TEST(ElasticDrive, IsInEquilibrium)
{
  const DoubleRollerCase input = drive_case("exact", soft());
  Eigen::Matrix2d spring;
  spring << 400e3, 30e3, 30e3, 300e3;
  EXPECT_LT((input.supports.elastic.at(SupportPart::carrier).stiffness - spring).norm(), 1e-6);
  EXPECT_EQ(input.supports.elastic.at(SupportPart::crank).constant, roller_constant(6));
  const PinData pin{ .diameter = 4, .free_length = 10, .youngs_modulus = 206e3, .poissons_ratio = 0.3 };
  EXPECT_NEAR(input.supports.elastic.at(SupportPart::pin).stiffness(0, 0) * pin.compliance(), 1, 1e-12);
  expect_equilibrium(input, { 2e3, 40e3 });
}

// Overlaps that a carrier which floats within the clearance of its bearing parts; pins of a millimetre;
// needles with clearance.
TEST(ElasticDrive, IsInEquilibriumWhereLittleHoldsIt)
{
  expect_equilibrium(
      drive_case("exact", { "drive.carrier_bearing.type=\"balls\"", "drive.carrier_bearing.elements=9",
                            "drive.carrier_bearing.ball_constant_N_per_mm_1_5=3e5",
                            "drive.carrier_bearing.radial_clearance_um=50" }),
      { 0, 10, 40e3 });
  expect_equilibrium(drive_case("exact", { "drive.uniform_clearance_um=3", "drive.pins.type=\"cantilever\"",
                                           "drive.pins.diameter_mm=1" }),
                     { 10, 500 });
  expect_equilibrium(drive_case("exact", { "drive.uniform_clearance_um=3", "drive.needles.type=\"rollers\"",
                                           "drive.needles.elements=11", "drive.needles.element_length_mm=8",
                                           "drive.needles.radial_clearance_um=6" }),
                     { 10, 40e3 });
}

// Light torques: the carrier floats up to where its bearing and its pairs hold it, from the first on.
TEST(ElasticDrive, BeginsWhereClearancesEnd)
{
  const DoubleRollerCase input = drive_case("elastic");
  const LoadedDrive drive(input);
  const double least = drive.solve(2 * degree, 1e-4).lag;
  for (const double torque : { 1e-2, 1.0 })
    EXPECT_NEAR(drive.solve(2 * degree, torque).lag, least, 1e-3 * least) << torque;
  EXPECT_GT(drive.solve(2 * degree, 1e3).lag, 1.05 * least);
}

// On one sleeve two supports in series are one whose compliances add up.
TEST(ElasticDrive, NeedlesAndPinsAreInSeries)
{
  const DoubleRollerCase rigid = drive_case("exact", { "drive.uniform_clearance_um=3" });
  DoubleRollerCase both = rigid, one = rigid;
  both.supports.elastic[SupportPart::pin] = { .stiffness = 2e5 * Eigen::Matrix2d::Identity() };
  both.supports.elastic[SupportPart::needles] = { .stiffness = 3e5 * Eigen::Matrix2d::Identity() };
  one.supports.elastic[SupportPart::needles] = { .stiffness = 1.2e5 * Eigen::Matrix2d::Identity() };
  const LoadedDrive drive(both), other(one);
  const DrivePosition p = drive.solve(3 * degree, 20e3), q = other.solve(3 * degree, 20e3);
  EXPECT_NEAR(p.lag, q.lag, 1e-9 * q.lag);
  EXPECT_NEAR(p.stiffness, q.stiffness, 1e-9 * q.stiffness);
  EXPECT_NEAR(p.shares.support[0], 0.4 * q.shares.support[0], 1e-9 * q.lag);
}

// Where coast flanks carry, the torque does not tell what each part gives way.
TEST(ElasticDrive, HasNoPartsWhereCoastFlanksCarry)
{
  const DoubleRollerCase input = drive_case(
      "exact", { "drive.crank_bearing.type=\"spring\"", "drive.crank_bearing.stiffness_N_per_um=[100]" });
  const LoadedDrive drive(input);
  const DrivePosition light = drive.solve(5 * degree, 100), heavy = drive.solve(5 * degree, 40e3);
  EXPECT_TRUE(std::isnan(light.shares.contact) && std::isnan(light.shares.gaps));
  EXPECT_NEAR(heavy.shares.contact + heavy.shares.support[3] + heavy.shares.gaps, heavy.lag,
              1e-12 * heavy.lag);
}

TEST(ElasticDrive, IsTheRigidOneWhereItsSupportsAreStiff)
{
  for (const std::string clearance : { "drive.uniform_clearance_um=3", "drive.uniform_clearance_um=0" })
    {
      const DoubleRollerCase rigid = drive_case("exact", { clearance }); // without clearance it is preloaded
      DoubleRollerCase on_bearings = rigid, on_pins = rigid;
      for (const SupportPart part : { SupportPart::carrier, SupportPart::crank })
        on_bearings.supports.elastic[part] = { .stiffness = 1e17 * Eigen::Matrix2d::Identity() };
      on_pins.supports.elastic[SupportPart::pin] = on_bearings.supports.elastic[SupportPart::crank];
      const LoadedDrive other(rigid);
      for (const DoubleRollerCase *elastic : { &on_bearings, &on_pins })
        {
          const LoadedDrive drive(*elastic);
          for (const double torque : { 0.0, 5e3, 40e3 })
            {
              const DrivePosition p = drive.solve(11 * degree, torque), q = other.solve(11 * degree, torque);
              EXPECT_NEAR(p.lag, q.lag, 1e-9 * std::abs(q.lag)) << torque << ' ' << clearance;
              EXPECT_NEAR(p.stiffness, q.stiffness, 1e-9 * q.stiffness);
              EXPECT_NEAR(p.gear_ratio, q.gear_ratio, 1e-9 * q.gear_ratio);
            }
        }
    }
}

// Rates of the whole drive against differences of two solutions.
TEST(ElasticDrive, RatesAreThoseOfItsSolutions)
{
  const DoubleRollerCase input = drive_case("exact", soft());
  const LoadedDrive drive(input);
  const double phi = 5 * degree, torque = 30e3;
  const DrivePosition p = drive.solve(phi, torque), more = drive.solve(phi, 1.001 * torque),
                      less = drive.solve(phi, 0.999 * torque);
  EXPECT_NEAR(p.stiffness, 0.002 * torque / (more.lag - less.lag), 1e-4 * p.stiffness);
  const double h = 1e-4, turned = drive.solve(phi + h, torque).psi - drive.solve(phi - h, torque).psi;
  EXPECT_NEAR(p.gear_ratio, 2 * h / turned, 1e-4 * p.gear_ratio);
}

// The torque's work is what contacts, pins and bearings store: T dlag/dT = dU/dT, and all parts of the
// transmission error are there.
TEST(ElasticDrive, StoresTheWorkOfItsTorque)
{
  const DoubleRollerCase input = drive_case(
      "exact", { "drive.uniform_clearance_um=3", "drive.pins.type=\"cantilever\"", "drive.pins.diameter_mm=4",
                 "drive.carrier_bearing.type=\"spring\"", "drive.carrier_bearing.stiffness_N_per_um=[200]" });
  const LoadedDrive drive(input);
  const auto energy = [&](const DrivePosition &p) {
    double sum = 0;
    for (const SupportLoad &s : p.supports)
      sum += 0.5 * force(s).dot(displacement(s));
    const GaussRule &rule = gauss(5);
    for (const RollerPairLoad &pair : p.pairs)
      for (std::size_t q = 0; q < rule.point.size(); ++q)
        sum += rule.weight[q] * pair.approach *
               drive.laws().load_at(input.contact.sleeve_radius, rule.point[q] * pair.approach).force;
    return sum;
  };
  const double torque = 20e3;
  const DrivePosition more = drive.solve(4 * degree, 1.01 * torque),
                      less = drive.solve(4 * degree, 0.99 * torque), p = drive.solve(4 * degree, torque);
  const double work = torque * (more.lag - less.lag);
  EXPECT_NEAR(energy(more) - energy(less), work, 2e-4 * work);
  // Gaps that were open at the nominal rotation, by the forces of the pairs that closed them.
  double by_gaps = 0, carried = 0;
  for (const RollerPairLoad &pair : p.pairs)
    {
      by_gaps += pair.force *
                 drive.drive()
                     .pair(pair.roller, pair.sleeve, p.crank_angle, drive.drive().nominal_psi(p.crank_angle))
                     .gap;
      carried += pair.force * pair.lever;
    }
  EXPECT_NEAR(p.shares.gaps, by_gaps / carried, 0.01 * p.lag); // levers change by as much on the way
  EXPECT_GT(p.shares.support[1], p.shares.contact);            // pins
  EXPECT_GT(p.shares.support[2], 0);                           // bearing of the carrier
  EXPECT_EQ(p.shares.support[0], 0);
  EXPECT_EQ(p.shares.support[3], 0);
}

// A drive of another size and stiffness under loads to match; and the next pitch of the rollers.
TEST(ElasticDrive, IsTheSameInAnyUnitsAndAPitchOn)
{
  const DoubleRollerCase input =
      drive_case("exact", soft({ "drive.carrier_bearing.stiffness_N_per_um=[350]" }));
  DoubleRollerCase scaled = input;
  const double length = 3.7, modulus = 0.013;
  for (double *value :
       { &scaled.drive.roller_circle_radius, &scaled.drive.roller_radius, &scaled.drive.sleeve_circle_radius,
         &scaled.drive.sleeve_radius, &scaled.drive.eccentricity, &scaled.drive.clearance,
         &scaled.contact.roller_radius, &scaled.contact.sleeve_radius, &scaled.contact.width })
    *value *= length;
  scaled.contact.roller_modulus *= modulus;
  scaled.contact.sleeve_modulus *= modulus;
  for (const SupportPart part : { SupportPart::pin, SupportPart::carrier })
    scaled.supports.elastic[part].stiffness *= modulus * length;
  scaled.supports.elastic[SupportPart::crank].constant *= modulus * std::pow(length, 2 - 10.0 / 9);
  const LoadedDrive drive(input), other(scaled);
  for (const double torque : { 0.1e3, 5e3, 40e3 })
    {
      const DrivePosition p = drive.solve(9 * degree, torque),
                          q = other.solve(9 * degree, torque * modulus * std::pow(length, 3));
      EXPECT_NEAR(q.lag, p.lag, 1e-9 * p.lag);
      EXPECT_NEAR(q.shares.support[1], p.shares.support[1], 1e-8 * p.lag);
    }
  const DoubleRollerCase springs = drive_case(
      "exact", { "drive.uniform_clearance_um=3", "drive.pins.type=\"cantilever\"", "drive.pins.diameter_mm=4",
                 "drive.crank_bearing.type=\"spring\"", "drive.crank_bearing.stiffness_N_per_um=[80]" });
  const LoadedDrive even(springs);
  const DrivePosition p = even.solve(9 * degree, 20e3), q = even.solve(29 * degree, 20e3);
  EXPECT_NEAR(q.lag, p.lag, 1e-9 * p.lag);
}

TEST(ElasticDrive, RefusesWhatDoesNotMoveItsSleeves)
{
  const std::vector<std::string> pins = { "drive.pins.type=\"cantilever\"", "drive.pins.diameter_mm=4" };
  for (const std::string more :
       { "model.preset=\"paper\"", "drive.profile=\"conjugate\"", "model.torque_on=\"input\"",
         "drive.pins.diameter_mm=6", "drive.carrier_bearing.type=\"spring\"",
         "drive.carrier_bearing.elements=4", "drive.crank_bearing.type=\"balls\"" })
    {
      std::vector<std::string> settings = pins;
      settings.push_back(more);
      EXPECT_THROW(drive_case("exact", settings), InputError) << more;
    }
  EXPECT_THROW(drive_case("exact", { "drive.carrier_bearing.type=\"spring\"",
                                     "drive.carrier_bearing.stiffness_N_per_um=[1, 2, 3]" }),
               InputError); // k_xy too great
}
