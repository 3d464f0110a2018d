// SPDX-License-Identifier: GPL-2.0-or-later
// How the drive moves on: ratios, stiffnesses and slopes, what repeats after which period, power.
#include "cases/double_roller/results.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/drive_cases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

using namespace flank;
using units::degree;

TEST(Drive, InstantaneousRatioIsTheQuotientOfItsOwnRotations)
{
  // Away from where a pair comes into contact or leaves it. 1e-6: central differences of rotations that stand
  // to 1e-16, over a step that leaves 1e-8 of the next order.
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
    { "exact", {} },
    { "exact", { "model.geometry=linear" } },
    { "exact", { "model.backlash=zero" } },
    { "exact", { "model.backlash=drive_only" } },
    { "crowned", {} },
    { "exact", { "drive.uniform_clearance_um=0.8" } },
    { "conjugate", {} },
    { "paper", {} },
  };
  constexpr double h = 1e-5;
  for (const auto &[name, settings] : cases)
    for (const std::string torque_on : { "output", "input" })
      {
        auto all = settings;
        all.push_back("model.torque_on=" + torque_on);
        const DoubleRollerCase input = drive_case(name, all);
        const LoadedDrive drive(input);
        const double torque = torque_on == "output" ? 20e3 : 20e3 / 17;
        const auto rollers = [](const DrivePosition &p) {
          std::vector<std::pair<int, int>> result;
          for (const RollerPairLoad &pair : p.pairs)
            result.push_back({ pair.roller, pair.sleeve });
          return result;
        };
        int compared = 0;
        for (double phi = 0.7 * degree; phi < 20 * degree; phi += 1.9 * degree)
          {
            const DrivePosition here = drive.solve(phi, torque), ahead = drive.solve(phi + h, torque),
                                behind = drive.solve(phi - h, torque);
            if (rollers(ahead) != rollers(here) || rollers(behind) != rollers(here))
              continue;
            const double quotient = 2 * h / (ahead.psi - behind.psi);
            EXPECT_NEAR(here.gear_ratio, quotient, 1e-6 * quotient)
                << name << ", " << fmt::format("{}", fmt::join(all, " ")) << ", " << phi / degree;
            ++compared;
          }
        EXPECT_GE(compared, 8) << name;
      }
}

TEST(Drive, StiffnessIsTheSlopeOfTheCarriersTorque)
{
  // At a resting crank. The torque is summed here from forces and levers; on the crank it is another one than
  // the balance has.
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
    { "exact", {} },
    { "exact", { "model.torque_on=input" } },
    { "exact", { "drive.uniform_clearance_um=0.8" } },
    { "crowned", {} },
    { "conjugate", {} },
    { "conjugate", { "drive.crown.type=full", "drive.crown.radius_mm=150" } },
  };
  for (const auto &[name, settings] : cases)
    {
      auto all = settings;
      all.insert(all.end(), { "contact_grid.cells_across=10", "contact_grid.cells_along=10" });
      const DoubleRollerCase input = drive_case(name, all);
      const LoadedDrive drive(input);
      const double torque = input.model.input_torque ? 20e3 / 17 : 20e3, step = 1e-4 * torque;
      const auto carried = [](const DrivePosition &p) {
        return std::accumulate(
            p.pairs.begin(), p.pairs.end(), 0.0,
            [](const double sum, const RollerPairLoad &load) { return sum + load.lever * load.force; });
      };
      for (const double phi : { 1.3 * degree, 8.7 * degree })
        {
          const DrivePosition more = drive.solve(phi, torque + step), less = drive.solve(phi, torque - step);
          const double slope = (carried(more) - carried(less)) / (more.lag - less.lag);
          EXPECT_NEAR(drive.solve(phi, torque).stiffness, slope, 1e-6 * slope)
              << name << ", " << phi / degree;
        }
    }
}

// After a pitch of the rollers all is as before, but for the numbers of the parts: what is left is rounding.
// An angle's rounding of 4e-17 rad is 1e-12 of the lag at 5 N m; gaps formed in double precision left 8e-11.
TEST(Drive, RepeatsAfterAPitchToTheDigitsOfAnAngle)
{
  for (const char *preset : { "paper", "exact" })
    {
      const DoubleRollerCase input = drive_case(preset);
      const LoadedDrive drive(input);
      for (const double phi : { 0.0, 5 * degree, 15 * degree })
        {
          const DrivePosition here = drive.solve(phi, 5e3),
                              there = drive.solve(phi + drive.drive().period(), 5e3);
          EXPECT_NEAR(there.lag, here.lag, 1e-12 * here.lag) << preset;
          EXPECT_NEAR(there.stiffness, here.stiffness, 1e-11 * here.stiffness) << preset; // by differences
        }
    }
}

// 1e-9 of what the drive does one period of its errors later; a pitch later it does something else.
TEST(Drive, RepeatsWithErrorsOfSinglePartsAfterTheirPeriod)
{
  const auto scatter = [](const int count) {
    std::vector<double> errors;
    for (int k = 0; k < count; ++k)
      errors.push_back(std::sin(3.0 * k * k + k));
    return fmt::format("[{:.3f}]", fmt::join(errors, ","));
  };
  const std::string rollers = "drive.roller_radial_errors_um=" + scatter(18),
                    sleeves = "drive.sleeve_radius_errors_um=" + scatter(17);
  for (const auto &[settings, period] : std::vector<std::pair<std::vector<std::string>, double>>{
           { { rollers }, 360 }, { { sleeves }, 340 }, { { rollers, sleeves }, 360 * 17 } })
    {
      const DoubleRollerCase input = drive_case("exact", settings);
      const LoadedDrive drive(input);
      EXPECT_NEAR(drive.drive().period(), period * degree, 1e-12 * period);
      for (const double phi : { 0.0, 7 * degree })
        {
          const double here = drive.solve(phi, 5e3).lag;
          EXPECT_NEAR(drive.solve(phi + period * degree, 5e3).lag, here, 1e-9 * std::abs(here));
          EXPECT_GT(std::abs(drive.solve(phi + 20 * degree, 5e3).lag - here), 1e-3 * std::abs(here));
        }
    }
}

TEST(Drive, SlopeOfAStudysPointIsThatOfItsTransmissionError)
{
  for (const auto &[name, on, torque] : { std::tuple{ "exact", "output", 20.0 },
                                          { "exact", "input", 1.2 },
                                          { "crowned", "input", 0.7 },
                                          { "conjugate", "output", 20.0 },
                                          { "conjugate", "input", 2.0 },
                                          { "paper", "input", 2.0 } })
    for (const double phi : { 3.0, 14.0 })
      {
        const DoubleRollerCase input = drive_case(name, { std::string("model.torque_on=") + on });
        const LoadedDrive drive(input);
        const double step = 5e-5 * torque; // N m
        const auto at = [&](const double t) {
          return study_point(input, drive.solve(phi * degree, t * 1e3));
        };
        const double slope = (at(torque + step).response - at(torque - step).response) / (2 * step);
        EXPECT_NEAR(at(torque).response_slope, slope, 1e-6 * slope) // um / (N m)
            << name << ", torque on the " << on << ", " << phi << " deg";
      }
}

TEST(ConjugateDrive, ClearanceIsTakenUpWhereTheLeverIsGreatest)
{
  const DoubleRollerCase input = drive_case("conjugate", { "drive.uniform_clearance_um=6" });
  const LoadedDrive drive(input);
  for (const double phi : { 0.0, 5 * degree, 13 * degree })
    {
      double greatest = 0;
      for (int k = 1; k <= input.drive.rollers; ++k)
        greatest = std::max(greatest, drive.drive().conjugate_contact(k, phi).lever);
      EXPECT_NEAR(drive.solve(phi, 0).lag, 6e-3 / greatest, 1e-15);
    }
}

TEST(ConjugateDrive, CrankAndCarrierHaveTheSamePower)
{
  // Nothing slips away: under constant load the carrier turns by 1/N_s of the crank, so N_s times the crank's
  // torque lags as much.
  const std::vector<std::string> few = { "contact_grid.cells_across=10", "contact_grid.cells_along=10" };
  const DoubleRollerCase output = drive_case("conjugate", few),
                         input = drive_case("conjugate", { few[0], few[1], "model.torque_on=input" });
  const LoadedDrive on_carrier(output), on_crank(input);
  for (const double phi : { 0.0, 5 * degree, 13 * degree })
    {
      const double lag = on_carrier.solve(phi, 20e3).lag;
      EXPECT_NEAR(on_crank.solve(phi, 20e3 / 17).lag, lag, 1e-10 * lag);
    }
}

TEST(Drive, OfTheDriveFlankAloneNothingOfTheCoastFlankCarries)
{
  const DoubleRollerCase input = drive_case("exact", { "model.backlash=drive_only" });
  const LoadedDrive drive(input);
  for (const double torque : { 1.0, 2e3, 20e3 })
    {
      const DrivePosition position = drive.solve(3 * degree, torque);
      EXPECT_FALSE(position.pairs.empty());
      for (const RollerPairLoad &load : position.pairs)
        EXPECT_GT(load.lever, 0) << torque;
    }
}

// Errors drawn from a tolerance: within it, spread evenly, in proportion to it, beside those of lists, and
// the same whatever else is drawn.
TEST(Tolerances, DrawErrorsOfTheirOwn)
{
  const auto errors = [](const std::vector<std::string> &settings) {
    std::vector<std::string> all = { "drive.uniform_clearance_um=20", "drive.tolerances.seed=7" };
    all.insert(all.end(), settings.begin(), settings.end());
    return drive_case("exact", all).drive;
  };
  const DoubleRollerData one = errors({ "drive.tolerances.roller_radius_um=2" }),
                         other = errors({ "drive.tolerances.roller_radius_um=4",
                                          "drive.tolerances.sleeve_position_um=3" }),
                         next = errors({ "drive.tolerances.roller_radius_um=2", "drive.tolerances.seed=8" });
  ASSERT_EQ(one.roller_radius_error.size(), 18u);
  ASSERT_EQ(other.sleeve_position_error.size(), 17u);
  EXPECT_TRUE(one.sleeve_position_error.empty() && one.roller_position_error.empty());
  double squares = 0, of_next = 0, sum = 0;
  for (std::size_t k = 0; k < one.roller_radius_error.size(); ++k)
    {
      const double error = one.roller_radius_error[k];
      EXPECT_LT(std::abs(error), 2e-3);
      EXPECT_NEAR(other.roller_radius_error[k], 2 * error, 1e-15);
      squares += error * error, of_next += error * next.roller_radius_error[k], sum += error;
    }
  for (const Eigen::Vector2d &error : other.sleeve_position_error)
    {
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 3e-3);
      squares += 4.0 / 9 * error.squaredNorm(), sum += 2.0 / 3 * error.sum();
    }
  // 52 draws of even spread: a third of the tolerance squared, of which their mean square is 12 % off.
  EXPECT_NEAR(squares / 52, 4e-6 / 3, 0.4 * 4e-6 / 3);
  EXPECT_LT(std::abs(sum), 3 * std::sqrt(52 * 4e-6 / 3)); // of both signs
  EXPECT_LT(std::abs(of_next), 0.7 * 18 * 4e-6 / 3);      // another seed's are others
  const std::string list = "drive.roller_radius_errors_um=[1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]";
  const DoubleRollerData both = errors({ "drive.tolerances.roller_radius_um=2", list });
  EXPECT_NEAR(both.roller_radius_error[0], one.roller_radius_error[0] + 1e-3, 1e-15);
  EXPECT_EQ(both.roller_radius_error[1], one.roller_radius_error[1]);
  EXPECT_EQ(drive_case("exact", { "drive.eccentricity_error_um=-5" }).drive.eccentricity, 1 - 5e-3);
  EXPECT_THROW(errors({ "drive.tolerances.roller_radius_um=2", "drive.roller_radius_errors_um=[1, 2]" }),
               InputError);
  EXPECT_THROW(errors({}), InputError); // a seed for nothing
}
