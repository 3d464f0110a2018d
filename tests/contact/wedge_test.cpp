// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/half_space.hpp"
#include "contact/wedge/edge_exponent.hpp"
#include "contact/wedge/edge_field_on_demand.hpp"
#include "contact/wedge/strip_means.hpp"
#include "contact/wedge/wave_load.hpp"
#include "mesh/base/units.hpp"

#include <gtest/gtest.h>

#include <functional>

#include <array>
#include <cmath>
#include <map>

using namespace flank;
using units::pi;

namespace
{
  constexpr double nu = 0.3;

  const wedge::EdgeField &field(const double degrees)
  {
    static std::map<double, wedge::EdgeField> made;
    return made.try_emplace(degrees, degrees * pi / 180, nu).first->second;
  }

  /// Stress of a displacement's gradient, Young's modulus 1.
  Eigen::Matrix3d stress(const Eigen::Matrix3d &gradient)
  {
    const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
    return (strain + nu / (1 - 2 * nu) * strain.trace() * Eigen::Matrix3d::Identity()) / (1 + nu);
  }

  /// Stress of the whole field at (x, s, z) under a unit force at distance 1.
  Eigen::Matrix3d whole_stress(const wedge::EdgeField &wedge, const Eigen::Vector3d &at)
  {
    return half_space::boussinesq_stress(at - Eigen::Vector3d(0, 1, 0), nu) + stress(wedge.gradient(at, 1));
  }
} // namespace

// Fourier transforms along the line of Boussinesq's stresses, by a sum over places (the tail's end is
// smooth).
TEST(WaveLoad, IsTheTransformOfAPointLoad)
{
  for (const auto &[s, z] : { std::pair{ 0.7, 0.4 }, { -1.2, 2.0 }, { 0.05, 0.1 } })
    {
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      const double step = 1e-3;
      for (double t = -9; t < 9; t += step)
        {
          const double x = std::sinh(t), weight = step * std::cosh(t) * std::exp(-std::pow(x / 600, 2));
          Eigen::Matrix3d wave = Eigen::Matrix3d::Constant(std::cos(x));
          wave(0, 1) = wave(1, 0) = wave(0, 2) = wave(2, 0) = std::sin(x);
          sum += weight * half_space::boussinesq_stress({ x, s, z }, nu).cwiseProduct(wave);
        }
      const wedge::WaveStress found = wedge::wave_load_stress(s, z, nu);
      const double tolerance = 1e-5 * sum.cwiseAbs().maxCoeff(); // of the sum, whose end is 600 waves away
      EXPECT_NEAR(found.xx, sum(0, 0), tolerance);
      EXPECT_NEAR(found.ss, sum(1, 1), tolerance);
      EXPECT_NEAR(found.zz, sum(2, 2), tolerance);
      EXPECT_NEAR(found.sz, sum(1, 2), tolerance);
      EXPECT_NEAR(found.xs, sum(0, 1), tolerance);
      EXPECT_NEAR(found.xz, sum(0, 2), tolerance);
    }
}

// What makes it the solution: with the half-space's field both faces are free of traction, from a hundredth
// of the load's distance to thirty times it, beside the load and before it.
TEST(EdgeField, LeavesBothFacesFree)
{
  for (const double degrees : { 45.0, 66.1, 90.0, 113.9, 135.0 })
    {
      const wedge::EdgeField &wedge = field(degrees);
      const double angle = degrees * pi / 180;
      const Eigen::Vector3d normal(0, -std::sin(angle), std::cos(angle));
      for (const double along : { 0.0, 0.3, 1.0, 3.0, 10.0 })
        for (const double r : { 0.02, 0.1, 0.5, 1.0, 3.0, 10.0, 30.0 })
          {
            // Gradients of cubic elements at their borders; beside the load tractions are 0.1 to 0.3.
            const double size = std::hypot(along, r), free = 0.022 / (1 + size * size);
            const Eigen::Vector3d on_end(along, r * std::cos(angle), r * std::sin(angle));
            EXPECT_LT((whole_stress(wedge, on_end) * normal).norm(), free)
                << degrees << ' ' << along << ' ' << r;
            if (std::hypot(along, r - 1) > 0.2)
              {
                EXPECT_LT(stress(wedge.gradient({ along, r, 0 }, 1)).col(2).norm(), free)
                    << degrees << ' ' << along << ' ' << r;
              }
          }
    }
}

TEST(EdgeField, AFlatWedgeAddsNothing)
{
  const wedge::EdgeField flat(pi, nu);
  for (const Eigen::Vector3d &at : { Eigen::Vector3d(0.3, 0.5, 0.4), { 2, -1, 1 }, { 0, 3, 0 } })
    EXPECT_LT(flat.displacement(at, 1).norm(), 1e-9);
}

// The gradient is that of the displacement.
TEST(EdgeField, GradientByDifferences)
{
  const wedge::EdgeField &wedge = field(66.1);
  for (const Eigen::Vector3d &at :
       { Eigen::Vector3d(0.3, 0.5, 0.4), { -2, 1, 1 }, { 0.1, 3, 0.2 }, { -0.05, 0.04, 0.03 } })
    for (int axis = 0; axis < 3; ++axis)
      {
        const Eigen::Vector3d off = 1e-5 * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector3d slope =
            (wedge.displacement(at + off, 0.7) - wedge.displacement(at - off, 0.7)) / 2e-5;
        EXPECT_LT((wedge.gradient(at, 0.7).col(axis) - slope).norm(), 1e-3 * slope.norm() + 1e-6);
      }
}

// Maxwell and Betti: exchanging load and place changes nothing. The two come from different waves and radii.
TEST(EdgeField, IsReciprocal)
{
  for (const double degrees : { 66.1, 90.0, 113.9 })
    for (const auto &[along, s, d] : { std::array{ 0.0, 0.5, 2.0 },
                                       { 0.3, 0.2, 1.0 },
                                       { 2.0, 0.1, 3.0 },
                                       { 5.0, 1.0, 0.2 },
                                       { 20.0, 1.0, 0.5 },
                                       { 0.0, 0.01, 1.0 } })
      {
        const double forth = field(degrees).displacement({ along, s, 0 }, d).z(),
                     back = field(degrees).displacement({ along, d, 0 }, s).z();
        EXPECT_NEAR(forth, back, 1e-4 * forth) << degrees << ' ' << along << ' ' << s << ' ' << d;
        EXPECT_NEAR(field(degrees).face().at(along, s, d), forth, 1e-4 * forth);
      }
}

// No length of its own.
TEST(EdgeField, ScalesWithTheDistance)
{
  const wedge::EdgeField &wedge = field(113.9);
  const Eigen::Vector3d at(0.4, 0.3, 0.8);
  EXPECT_LT((wedge.displacement(7.3 * at, 7.3 * 0.9) * 7.3 - wedge.displacement(at, 0.9)).norm(), 1e-12);
  EXPECT_NEAR(wedge.face().at(7.3 * 0.2, 7.3 * 0.4, 7.3 * 0.1) * 7.3, wedge.face().at(0.2, 0.4, 0.1), 1e-12);
}

TEST(EdgeField, IsOneForAllWhoHoldItAtATime)
{
  const auto one = wedge::edge_field_on_demand(1.2, 0.3), same = wedge::edge_field_on_demand(1.2, 0.3),
             other = wedge::edge_field_on_demand(1.2, 0.29), wider = wedge::edge_field_on_demand(1.3, 0.3);
  EXPECT_EQ(one, same);
  EXPECT_NE(one, other);
  EXPECT_NE(one, wider);
  const Eigen::Vector3d place(0.3, 0.8, 0.4);
  EXPECT_EQ(one->field().displacement(place, 0.7), wedge::EdgeField(1.2, 0.3).displacement(place, 0.7));
}

// Displacement of the middle of a patch of 0.3 by 0.5 that touches the edge, over that on a half-space. By
// bricks of cubic elements that resolve the patch: 1.05, 1.345, 2.52 at 113.5, 90, 66.5 degrees, and 0.975
// inside: the bricks are held 6 to 12 away. At 90 degrees Hetenyi's images on ever finer cells go to 1.42.
TEST(StripMeans, ComplianceAtTheEdge)
{
  const double a = 0.15, b = 0.25, small = 1e-3,
               half_space = (1 - nu * nu) / pi * half_space::love_potential({ 0, 0, a, b }, 0, 0);
  const auto ratio = [&](const double degrees) {
    const wedge::FaceTable table = field(degrees).face();
    return 1 +
           wedge::StripMeans(table, { 0, 2 * b }, { b - small, b + small }).mean(0, a, small) / half_space;
  };
  for (const auto &[degrees, bricks] : { std::pair{ 113.5, 1.05 }, { 90.0, 1.345 }, { 66.5, 2.52 } })
    {
      // What the bricks' held faces keep back: inside 0.025, at the edge as much more as a wedge yields more
      // than a half-space at their distance.
      const double far = 6,
                   held = 0.025 * (1 + field(degrees).face().at(far, b, b) / ((1 - nu * nu) / pi / far));
      EXPECT_NEAR(ratio(degrees), bricks + held, 0.01 * ratio(degrees)) << degrees;
    }
  EXPECT_NEAR(ratio(90), 1.42, 0.01);
}

TEST(StripMeans, AreMeans)
{
  using wedge::Strip;
  const wedge::FaceTable table = field(66.1).face();
  const auto mean = [&](const Strip &first, const Strip &second, const double along, const double a,
                        const double b) { return wedge::StripMeans(table, first, second).mean(along, a, b); };
  // Of small patches far apart: the value between their middles.
  EXPECT_NEAR(mean({ 1.99, 2.01 }, { 0.49, 0.51 }, 0.7, 0.01, 0.01), table.at(0.7, 2, 0.5),
              1e-3 * table.at(0.7, 2, 0.5));
  // A strip is the mean of its parts, also at the edge, where the value between places grows without bounds.
  const Strip whole{ 0, 0.5 }, low{ 0, 0.125 }, high{ 0.125, 0.5 };
  for (const double along : { 0.0, 0.05, 0.6, 8.0 })
    for (const Strip &other : { whole, Strip{ 0.5, 1 }, Strip{ 3, 4 } })
      {
        const double one = mean(other, whole, along, 0.1, 0.03),
                     of_parts = 0.25 * mean(other, low, along, 0.1, 0.03) +
                                0.75 * mean(other, high, along, 0.1, 0.03);
        EXPECT_NEAR(of_parts, one, 4e-3 * one) << along;
        EXPECT_NEAR(mean(whole, other, -along, 0.03, 0.1), one, 1e-12 * one);
      }
  // Of the table's means along the edge, which it does not have to say at each place.
  for (const auto &[first, second] : { std::pair{ whole, whole },
                                       { Strip{ 0.1, 0.6 }, Strip{ 0, 0.5 } },
                                       { Strip{ 0.2, 0.7 }, Strip{ 0.1, 0.6 } },
                                       { Strip{ 1, 1.5 }, Strip{ 0.5, 1 } } })
    for (const double along : { 0.0, 0.01, 0.1, 0.3, 0.5, 1.0, 2.5, 20.0 })
      {
        const double value = table.mean(along, first, second);
        EXPECT_NEAR(mean(first, second, along, 1e-6, 1e-6), value, 2e-3 * value) << first.low << ' ' << along;
      }
  // A patch is the mean of its halves along the edge.
  const double own = mean(whole, whole, 0, 0.1, 0.1);
  EXPECT_NEAR(0.5 * mean(whole, whole, 0, 0.05, 0.05) + 0.5 * mean(whole, whole, 0.1, 0.05, 0.05), own,
              2e-3 * own);
  // However much longer along the edge than its strip is wide: halved until it is not.
  const std::function<double(const Strip &, const Strip &, double, double)> by_halves =
      [&](const Strip &first, const Strip &second, const double along, const double a) {
        return a < 0.2 * (first.high + second.high) ? mean(first, second, along, a, a)
                                                    : 0.5 * by_halves(first, second, along, a / 2) +
                                                          0.25 * (by_halves(first, second, along - a, a / 2) +
                                                                  by_halves(first, second, along + a, a / 2));
      };
  for (const double high : { 0.3, 0.02, 0.002 })
    for (const double along : { 0.0, 0.5, 1.0 })
      {
        const Strip edge{ 0, high }, beside{ high, 3 * high };
        EXPECT_NEAR(mean(edge, edge, along, 0.5, 0.5), by_halves(edge, edge, along, 0.5),
                    2e-3 * mean(edge, edge, along, 0.5, 0.5))
            << high << ' ' << along;
        EXPECT_NEAR(mean(edge, beside, along, 0.5, 0.5), by_halves(edge, beside, along, 0.5),
                    2e-3 * mean(edge, beside, along, 0.5, 0.5))
            << high << ' ' << along;
      }
}

// The integral over both distances against a fine sum, where strips touch the edge and where both ways of a
// mean meet.
TEST(FaceTable, MeansAgainstSums)
{
  using wedge::Strip;
  const wedge::FaceTable table = field(66.1).face();
  for (const auto &[first, second] : { std::pair{ Strip{ 0, 0.5 }, Strip{ 0, 0.5 } },
                                       { { 0, 0.5 }, { 0.5, 1 } },
                                       { { 0.5, 1 }, { 0.5, 1 } },
                                       { { 0, 0.1 }, { 1, 3 } },
                                       { { 0.49, 0.99 }, { 0.5, 1 } },
                                       { { 0.51, 1.01 }, { 0.5, 1 } },
                                       { { 0, 1e-3 }, { 0, 1 } },
                                       { { 0, 1e-3 }, { 0.3, 0.6 } },
                                       { { 0, 1e-3 }, { 0.6, 1.2 } },
                                       { { 1e-3, 3e-3 }, { 0.3, 0.6 } } })
    for (const double along : { 0.003, 0.1, 1.0, 3.0, 3.2 })
      {
        double sum = 0;
        const int n = 400; // squares of places, so that there are more of them at the edge
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j)
            {
              const double u = (i + 0.5) / n, v = (j + 0.5) / n;
              sum +=
                  4 * u * v / n / n *
                  table.at(along, first.low + first.length() * u * u, second.low + second.length() * v * v);
            }
        EXPECT_NEAR(table.mean(along, first, second), sum, 2e-3 * sum)
            << first.low << ' ' << second.low << ' ' << along;
      }
}

// Powers of the pressure at the end of a frictionless contact.
TEST(PressureExponent, OfKnownCorners)
{
  using wedge::EndOfContact, wedge::pressure_exponent;
  const auto degrees = [](const double angle, const double modulus = 1) {
    return EndOfContact{ angle * pi / 180, modulus };
  };
  // A quarter-space on a half-space of the same material: lambda = 0.7740, as Dundurs and Lee's equation has
  // it.
  EXPECT_NEAR(pressure_exponent(degrees(90), degrees(180)), -0.2260, 1e-4);
  // On a rigid body that goes on, a rectangle's pressure is finite; a rigid one's on a half-space has the
  // power -1/2.
  EXPECT_EQ(pressure_exponent(degrees(90), degrees(180, 1e12)), 0);
  EXPECT_NEAR(pressure_exponent(degrees(90, 1e12), degrees(180)), -0.5, 1e-6);
  // Both end together: finite, at the ends of helical flanks too.
  for (const double helix : { 0.0, 10.0, 23.9, 40.0 })
    EXPECT_EQ(pressure_exponent(degrees(90 - helix), degrees(90 + helix)), 0) << helix;
  EXPECT_EQ(pressure_exponent(degrees(90), degrees(90, 0.01)), 0);
  // The sharper the shorter body, the weaker the singularity.
  EXPECT_GT(pressure_exponent(degrees(66), degrees(180)), pressure_exponent(degrees(90), degrees(180)));
  EXPECT_LT(pressure_exponent(degrees(114), degrees(180)), pressure_exponent(degrees(90), degrees(180)));
}
