// SPDX-License-Identifier: GPL-2.0-or-later
// Modifications by tables: between their points, against the formulas that they sample, kinks in them.
#include "contact/loaded/load_distribution.hpp"
#include "mesh/gear/topography.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

using namespace flank;
using units::degree;
using units::micrometre;

// A step between rows close together, far ones beside it: what lies between swings over by less than the
// step, along both axes, however close they are.
TEST(Topography, UnevenSpacingDoesNotSwing)
{
  for (const double close : { 2.0, 0.5, 0.1, 0.01, 1e-6 })
    for (const bool along_z : { false, true })
      {
        const std::vector<double> uneven = { 5, 20, 20 + close, 50 }, even = { -6, 0, 6 };
        Eigen::MatrixXd values(4, 3);
        for (int c = 0; c < 3; ++c)
          values.col(c) << 0, 0, 5, 5;
        const Topography table = along_z ? Topography("", even, uneven, values.transpose(), 50)
                                         : Topography("", uneven, even, values, 50);
        for (double at = 5; at <= 50; at += 0.01)
          {
            const double removed = along_z ? table.removed(1, at) : table.removed(at, 1);
            EXPECT_GT(removed, -2) << at << " " << close;
            EXPECT_LT(removed, 7) << at << " " << close;
          }
      }
}

TEST(Topography, SampledFormulaIsTheFormulaToItsInterpolationError)
{
  std::vector<double> roll, z;
  const auto table = [&](const int n, const auto &formula) {
    roll.clear(), z.clear();
    for (int i = 0; i < n; ++i)
      {
        roll.push_back(0.24 + 0.25 * i / (n - 1));
        z.push_back(-10 + 20.0 * i / (n - 1) + (i > 0 && i < n - 1 ? 0.3 * std::sin(i) / n : 0)); // uneven
      }
    Eigen::MatrixXd values(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        values(i, j) = formula(roll[i], z[j]);
    return Topography("table", roll, z, values, 50);
  };
  const auto worst = [&](const Topography &t, const auto &formula) {
    double error = 0;
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; j <= 100; ++j)
        {
          const double r = 0.24 + 0.0025 * i, w = -10 + 0.2 * j;
          error = std::max(error, std::abs(t.removed(r, w) - formula(r, w)));
        }
    return error;
  };
  const auto quadratic = [](double r, double w) {
    return 5e-3 * (r - 0.3) * (r - 0.3) + 1e-5 * w * w - 2e-4 * w * r;
  };
  EXPECT_LT(worst(table(6, quadratic), quadratic), 1e-15); // parabolas are reproduced
  const auto wave = [](double r, double w) { return 5e-3 * std::sin(20 * r) * std::cos(0.3 * w); };
  const double coarse = worst(table(11, wave), wave), fine = worst(table(21, wave), wave);
  EXPECT_LT(fine, coarse / 5.5); // third order: 8, less at the uneven ends
  EXPECT_LT(fine, 2e-5);
  // Once continuously differentiable: the slope does not jump at a node.
  const Topography t = table(11, wave);
  const double node = roll[5], h = 1e-7;
  EXPECT_NEAR((t.removed(node + h, 1.3) - t.removed(node, 1.3)) / h,
              (t.removed(node, 1.3) - t.removed(node - h, 1.3)) / h, 1e-6);
}

TEST(Topography, AKinkInATableIsOneToThePressure)
{
  const double base_radius = 70;
  const auto turn = [&](const double step, const auto &formula, const bool along_face = false) {
    std::vector<double> at, few{ -10, 0, 10 };
    for (double x = 0.3; x < 0.5; x += step)
      at.push_back(x);
    Eigen::MatrixXd values(at.size(), 3);
    for (std::size_t i = 0; i < at.size(); ++i)
      values.row(static_cast<Eigen::Index>(i)).setConstant(formula(at[i]));
    return along_face ? Topography("", few, at, values.transpose(), base_radius).turn().along_face
                      : Topography("", at, few, values, base_radius).turn().along_profile;
  };
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  const auto relief = [](const double x) { return 0.15 * std::max(0.0, x - 0.4013); };
  const auto rounded = [](const double x) { return 2 * std::pow(std::max(0.0, x - 0.4013), 2); };
  for (const double step :
       { 2e-4, 2e-3, 0.01 }) // the kink lies in an interval, which shares it with its neighbours
    {
      const double length = base_radius * 0.4 * step;
      EXPECT_GT(turn(step, relief), 1.5 * length);
      EXPECT_LT(turn(step, relief), 3.5 * length);
      EXPECT_LT(turn(step, relief, true), 3.5 * step);
    }
  for (const double step : { 2e-4, 2e-3, 0.01 })
    {
      EXPECT_EQ(turn(step, rounded), nowhere);
      EXPECT_EQ(turn(step, [](const double x) { return 5e-3 * std::sin(20 * x); }), nowhere);
      EXPECT_EQ(turn(step, [](const double x) { return 0.1 * x; }), nowhere);
    }
}

TEST(Topography, TableOfReliefAndCrownActsLikeThem)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const auto deg = [](const double d) { return d * degree; };
  const ProfileRelief relief("tip relief", 10e-3, deg(20.9), pair.pinion.tip_roll, ReliefShape::quadratic,
                             pair.pinion.base_radius);
  const LeadCrown crown(4e-3, 20);
  for (const std::string axis : { "roll_angle_deg", "diameter_mm", "length_of_roll_mm" })
    {
      std::string table = "# measured nowhere\nremoved_um(" + axis + ",z_mm)";
      for (int j = 0; j <= 10; ++j)
        table += "," + std::to_string(-10 + 2 * j);
      for (int i = 0; i <= 26; ++i)
        {
          const double roll = deg(14.2 + 0.5 * i);
          table += "\n" + std::to_string(axis == "roll_angle_deg" ? roll / degree
                                         : axis == "diameter_mm"
                                             ? 2 * radius_at_roll(roll, pair.pinion.base_radius)
                                             : roll * pair.pinion.base_radius);
          for (int j = 0; j <= 10; ++j)
            table += "," +
                     std::to_string((relief.removed(roll, 0) + crown.removed(0, -10 + 2.0 * j)) / micrometre);
        }
      write_table("formula.csv", table + "\n");
      const ParallelAxisCase a = read("topography = { file = \"formula.csv\" }"),
                             b = read("tip_relief = { amount_um = 10, start_roll_angle_deg = 20.9, shape = "
                                      "\"quadratic\" }\nlead_crown = { amount_um = 4 }");
      // The kink of curvature at the start leaves h^2 times its jump / 32: (0.5 deg)^2 10 um / (6.27 deg)^2 /
      // 16 = 4e-3 um.
      for (const double roll : { 15.0, 20.0, 20.9, 21.3, 25.77, 27.0 })
        for (const double z : { -9.7, 0.0, 3.33 })
          EXPECT_NEAR(removed(a.deviations.pinion.modifications, deg(roll), z),
                      removed(b.deviations.pinion.modifications, deg(roll), z), 1e-5);
      EXPECT_NEAR(te(pair, mesh_of(pair, a.deviations).solve(0.4, { 150e3 })[0]),
                  te(pair, mesh_of(pair, b.deviations).solve(0.4, { 150e3 })[0]), 0.01);
    }
}
