// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/double_roller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

using namespace flank;
using units::pi;

namespace
{
  DoubleRollerData paper_drive()
  {
    DoubleRollerData data;
    data.rollers = 18;
    data.roller_circle_radius = 26.65;
    data.roller_radius = 2.5;
    data.sleeve_circle_radius = 22.15;
    data.sleeve_radius = 3.0;
    data.eccentricity = 1.0;
    return data;
  }
} // namespace

TEST(DoubleRoller, GapsAndLeversOfThePaperAtZero) // design figures, given to these digits
{
  const DoubleRollerDrive drive(paper_drive());
  EXPECT_NEAR(drive.pair(1, 1, 0, 0).gap, 0.031956950523, 1e-9);
  EXPECT_NEAR(drive.pair(1, 1, 0, 0).lever, 18.185343414, 1e-8);
  EXPECT_NEAR(drive.pair(3, 3, 0, 0).gap, -0.000452493572, 1e-9);
  EXPECT_NEAR(drive.pair(3, 3, 0, 0).lever, 16.404391859, 1e-8);
  EXPECT_NEAR(drive.pair(9, 9, 0, 0).gap, 0, 1e-9);
  EXPECT_NEAR(drive.pair(9, 9, 0, 0).lever, 0, 1e-8);
}

TEST(DoubleRoller, LeverIsTheDerivativeOfTheGapAndThePapersInSize)
{
  const DoubleRollerDrive drive(paper_drive());
  for (const double phi : { 0.1, 1.0, 2.7 })
    for (const RollerPair &p : drive.pairs(phi, drive.nominal_psi(phi), 0.2))
      {
        const double psi = drive.nominal_psi(phi), h = 1e-6;
        EXPECT_NEAR(p.lever,
                    (drive.pair(p.roller, p.sleeve, phi, psi + h).gap -
                     drive.pair(p.roller, p.sleeve, phi, psi - h).gap) /
                        (2 * h),
                    1e-7);
        // The double-roller actuator article (bibliography in contact/bibliography.md), eq. 22:
        // contact at (R cos ns + R_r cos theta_r, R sin ns - R_r sin theta_r).
        const double sigma = 2 * pi / 18 * p.roller, a = 2 * pi / 17 * (p.sleeve - 0.5) - psi;
        const Eigen::Vector2d d = Eigen::Vector2d(26.65 * std::cos(sigma), 26.65 * std::sin(sigma)) -
                                  Eigen::Vector2d(std::cos(phi), std::sin(phi)) -
                                  22.15 * Eigen::Vector2d(std::cos(a), std::sin(a));
        const double tangent =
            -d.y() / d.x(); // of theta_r: the contact lies at -d/|d| from the roller's centre
        const double paper = (-tangent * std::cos(phi) - std::sin(phi) + 26.65 * std::sin(sigma) +
                              26.65 * tangent * std::cos(sigma)) /
                             std::sqrt(tangent * tangent + 1);
        EXPECT_NEAR(std::abs(p.lever), std::abs(paper), 1e-12);
      }
}

TEST(DoubleRoller, ContactRotationClosesTheGapOnBothFlanks)
{
  const DoubleRollerDrive drive(paper_drive());
  for (const double phi : { 0.0, 0.35, 2.0 })
    for (int n = 1; n <= 17; ++n)
      for (int k = 1; k <= 18; ++k)
        for (const DriveFlank flank : { DriveFlank::drive, DriveFlank::coast })
          if (const double psi = drive.contact_rotation(k, n, phi, flank); !std::isnan(psi))
            {
              const RollerPair p = drive.pair(k, n, phi, psi);
              EXPECT_NEAR(p.gap, 0, 1e-12);
              EXPECT_TRUE(flank == DriveFlank::drive ? p.lever >= -1e-6 : p.lever <= 1e-6);
            }
}

TEST(DoubleRoller, EverythingRepeatsAfterAPeriodWithTheNextPair)
{
  for (const int rollers : { 12, 18, 40 })
    {
      DoubleRollerData data = paper_drive();
      data.rollers = rollers;
      // Scaled so that the rolling circles keep their place: R and R1 with the number of rollers.
      data.roller_circle_radius *= rollers / 18.0;
      data.sleeve_radius = rollers == 12   ? 2.8
                           : rollers == 40 ? 3.3
                                           : 3.0; // below the crest's conjugate radius
      data.sleeve_circle_radius =
          data.roller_circle_radius + data.eccentricity - data.roller_radius - data.sleeve_radius;
      const DoubleRollerDrive drive(data);
      const double phi = 0.4, next = phi + drive.period();
      for (int n = 1; n < rollers - 1; ++n)
        {
          const RollerPair a = drive.pair(n, n, phi, drive.nominal_psi(phi) + 1e-4),
                           b = drive.pair(n + 1, n + 1, next, drive.nominal_psi(next) + 1e-4);
          EXPECT_NEAR(a.gap, b.gap, 1e-12);
          EXPECT_NEAR(a.lever, b.lever, 1e-12);
        }
    }
}

// All parts together, as gaps of the pairs that stand at one place; and no smaller number of pitches does it.
TEST(DoubleRoller, RepeatsWithItsErrorsAfterThePeriodAndNotBefore)
{
  const std::vector<double> alternating18{ 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2 };
  std::vector<double> all18, all17;
  for (int k = 0; k < 18; ++k)
    all18.push_back(std::sin(3.0 * k * k));
  for (int k = 0; k < 17; ++k)
    all17.push_back(std::cos(2.0 * k * k));
  const std::vector<double> equal18(18, 1), equal17(17, -1), none;
  const auto radial = [](const std::vector<double> &values, const double first) {
    std::vector<Eigen::Vector2d> errors;
    for (std::size_t k = 0; k < values.size(); ++k)
      errors.push_back(Eigen::Rotation2Dd(2 * pi * (k + first) / values.size()) *
                       Eigen::Vector2d(values[k], values[k] / 2) * 1e-3);
    return errors;
  };
  for (const auto &[rollers, sleeves, pitches] :
       std::vector<std::tuple<std::vector<double>, std::vector<double>, int>>{ { none, none, 1 },
                                                                               { equal18, equal17, 1 },
                                                                               { alternating18, none, 3 },
                                                                               { all18, equal17, 18 },
                                                                               { equal18, all17, 17 },
                                                                               { alternating18, all17, 51 },
                                                                               { all18, all17, 18 * 17 } })
    for (const bool in_radius : { true, false })
      {
        DoubleRollerData data = paper_drive();
        if (in_radius)
          {
            for (const double error : rollers)
              data.roller_radius_error.push_back(1e-3 * error);
            for (const double error : sleeves)
              data.sleeve_radius_error.push_back(1e-3 * error);
          }
        else
          {
            data.roller_position_error = radial(rollers, 1);
            data.sleeve_position_error = radial(sleeves, 0.5);
          }
        const DoubleRollerDrive drive(data);
        EXPECT_EQ(pitches_in_period(data), pitches);
        EXPECT_DOUBLE_EQ(drive.period(), pitches * 2 * pi / 18);
        for (int m = 1; m <= pitches; ++m)
          {
            const double phi = 0.4, next = phi + m * drive.roller_pitch();
            double change = 0;
            for (int n = 1; n <= 17; ++n)
              change = std::max(change, std::abs(drive.pair(n, n, phi, drive.nominal_psi(phi)).gap -
                                                 drive
                                                     .pair((n - 1 + m) % 18 + 1, (n - 1 + m) % 17 + 1, next,
                                                           drive.nominal_psi(next))
                                                     .gap));
            EXPECT_EQ(change < 1e-11, m == pitches) << m << " of " << pitches << ": " << change; // mm
          }
      }
}

TEST(DoubleRoller, ConjugateProfileKeepsTouching)
{
  const DoubleRollerDrive drive(paper_drive());
  // Closed form against the curvature of points of the trochoid (second differences).
  for (const double t : { 0.05, 0.11, 0.2 })
    {
      const double h = 1e-4;
      const auto point = [](const double s) {
        return Eigen::Vector2d(26.65 * std::cos(s) - std::cos(18 * s),
                               26.65 * std::sin(s) - std::sin(18 * s));
      };
      const Eigen::Vector2d d1 = (point(t + h) - point(t - h)) / (2 * h),
                            d2 = (point(t + h) - 2 * point(t) + point(t - h)) / (h * h);
      EXPECT_NEAR(drive.conjugate_radius(t),
                  std::pow(d1.norm(), 3) / (d1.x() * d2.y() - d1.y() * d2.x()) - 2.5, 1e-3);
    }
  EXPECT_NEAR(drive.conjugate_departure(pi / 17), 0, 1e-12);             // the circle touches it at its crest
  EXPECT_NEAR(drive.conjugate_departure(0.2 * pi / 17), 3.804e-3, 1e-5); // and leaves it by micrometres
  // Every drive contact has the lever of the roller's normal through the pitch point: sum rule of equal
  // rotation.
  double most = 0;
  for (int k = 1; k <= 18; ++k)
    most = std::max(most, drive.conjugate_contact(k, 0.3).lever);
  EXPECT_LT(most, 17 * 1.0 * 1.1 + 0.1); // N_s E is the pitch circle's radius
  EXPECT_GT(most, 0.9 * 17);
}

TEST(DoubleRoller, PartsThatAreAllTurnedAlikePreloadNothing)
{
  // Sleeves moved along their circle are the carrier turned: gaps at the nominal rotation, no preload.
  DoubleRollerData data = paper_drive();
  data.clearance = 0.0022;
  ASSERT_EQ(DoubleRollerDrive(data).least_gap().interference, 0);
  for (int n = 1; n <= 17; ++n)
    {
      const double at = (n - 0.5) * 2 * pi / 17;
      data.sleeve_position_error.emplace_back(-0.03 * std::sin(at), 0.03 * std::cos(at));
    }
  const DoubleRollerDrive::LeastGap turned = DoubleRollerDrive(data).least_gap();
  EXPECT_LT(std::min(turned.drive, turned.coast), -0.02);
  EXPECT_EQ(turned.interference, 0);
  // What is left of it where the clearance is taken away is what is there without the error; second order.
  data.clearance = 0;
  const double with_error = DoubleRollerDrive(data).least_gap().interference;
  EXPECT_NEAR(with_error, DoubleRollerDrive(paper_drive()).least_gap().interference, 2e-4);
  // As much more clearance frees it: the definition.
  data.clearance = with_error;
  EXPECT_LT(DoubleRollerDrive(data).least_gap().interference, 1e-9);
  // One sleeve alone that is moved does preload.
  data = paper_drive();
  data.clearance = 0.0022;
  data.sleeve_position_error.assign(17, Eigen::Vector2d::Zero());
  data.sleeve_position_error[3] = { -0.01, 0.02 };
  EXPECT_GT(DoubleRollerDrive(data).least_gap().interference, 0.002);
}

TEST(DoubleRoller, RefusesWhatCannotBeAssembled)
{
  const auto quantity_of = [](const DoubleRollerData &data) {
    try
      {
        DoubleRollerDrive drive(data);
      }
    catch (const InputError &error)
      {
        return error.quantity;
      }
    return std::string("accepted");
  };
  EXPECT_EQ(quantity_of(paper_drive()), "accepted");
  DoubleRollerData data = paper_drive();
  data.sleeve_radius = 4.2;
  EXPECT_EQ(quantity_of(data), "sleeve radius"); // neighbours overlap
  data = paper_drive();
  data.roller_radius = 4.7;
  EXPECT_EQ(quantity_of(data), "roller radius");
  data = paper_drive();
  data.eccentricity = 1.6;
  EXPECT_EQ(quantity_of(data), "eccentricity");
  data = paper_drive();
  data.sleeve_radius = 3.05;
  EXPECT_EQ(quantity_of(data), "sleeve radius"); // 52 um of overlap
  data.clearance = 0.05;
  EXPECT_EQ(quantity_of(data), "accepted"); // which a clearance takes away
  data = paper_drive();
  data.roller_radius_error = { 0.001, 0.002 };
  EXPECT_EQ(quantity_of(data), "roller radius errors");
}
