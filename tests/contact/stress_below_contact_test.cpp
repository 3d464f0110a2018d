// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/tip_edges.hpp"
#include "contact/half_space/half_space.hpp"
#include "contact/loaded/stress_below_contact.hpp"
#include "mesh/base/units.hpp"
#include "tests/example_pairs.hpp"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace flank;
using units::degree;

TEST(StressBelowContact, LeavesHelicalEndsFree)
{
  // On the end plane of an acute and of an obtuse end, as both gears see them, at places below a force.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  for (const Gear *gear : { &pair.pinion, &pair.gear })
    for (const FlankEnd end : { FlankEnd::low, FlankEnd::high })
      {
        const FlankEdges ends(*gear);
        const double distance = 0.5, opening = opening_at(*gear, end), sign = sign_of(end),
                     z = sign * (gear->face_width / 2 - distance * std::cos(gear->base_helix_angle));
        ASSERT_NEAR(ends.distance(edge_at(end), { 0, z }), distance, 1e-12);
        const Eigen::Vector3d normal(0, sign * std::sin(opening), std::cos(opening));
        for (const double down : { 0.3, 0.6, 1.2 })
          for (const double aside : { 0.0, 0.4 })
            {
              const Eigen::Vector3d at(aside, sign * (distance - down * std::cos(opening)),
                                       down * std::sin(opening));
              const Eigen::Matrix3d half_space = half_space::boussinesq_stress(at, gear->poissons_ratio);
              const Eigen::Vector3d left =
                  (half_space + ends.added_stress(edge_at(end), { 0, z }, at)) * normal;
              EXPECT_LT(left.norm(), 0.03 * half_space.norm()) << opening << ' ' << down << ' ' << aside;
            }
      }
}

TEST(StressBelowContact, LeavesSharpTipsFree)
{
  // On the plane of the tip land, which a helical gear's generators meet at an angle, below a force.
  for (const double helix : { 0.0, 25.232 })
    {
      const Gear gear = make_gear_pair(paper_pair(helix)).pinion;
      const FlankEdges edges(gear);
      const double distance = 0.5, opening = opening_at_tip(gear),
                   slope = gear.base_radius * gear.tip_roll * gear.flank().roll_per_generator(),
                   skew = std::hypot(1, slope);
      ASSERT_EQ(edges.opening(FlankEdge::tip), opening);
      const FlankEdges::Place force{
        std::sqrt(gear.tip_roll * gear.tip_roll - 2 * distance * skew / gear.base_radius), 0.0
      };
      ASSERT_NEAR(edges.distance(FlankEdge::tip, force), distance, 1e-12);
      // Towards the edge and along it, in the half-space's axes.
      const Eigen::Vector3d towards(1 / skew, slope / skew, 0), along(-slope / skew, 1 / skew, 0);
      const Eigen::Vector3d normal =
          std::sin(opening) * towards + std::cos(opening) * Eigen::Vector3d::UnitZ();
      for (const double down : { 0.3, 0.6, 1.2 })
        for (const double aside : { 0.0, 0.4 })
          {
            const Eigen::Vector3d at = (distance - down * std::cos(opening)) * towards + aside * along +
                                       down * std::sin(opening) * Eigen::Vector3d::UnitZ();
            EXPECT_NEAR(edges.distance(FlankEdge::tip, force, at.head<2>()), down * std::cos(opening), 1e-12);
            const Eigen::Matrix3d half_space = half_space::boussinesq_stress(at, gear.poissons_ratio);
            const Eigen::Vector3d left =
                (half_space + edges.added_stress(FlankEdge::tip, force, at)) * normal;
            EXPECT_LT(left.norm(), 0.03 * half_space.norm()) << helix << ' ' << down << ' ' << aside;
          }
    }
}

TEST(StressBelowContact, NearASharpTipIsTheSumOfItsForces)
{
  // A line contact close to the tip of the pinion, of a spur and of a helical pair. Around the place that is
  // named no stress is greater, by forces at many points of each cell; far from the tip there is another.
  for (const double helix : { 0.0, 25.232 })
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      const Gear &gear = pair.pinion;
      constexpr int slices = 9, across = 16;
      constexpr double half_width = 0.2, peak = 1000, half_generator = 0.08,
                       half_profile = half_width / across;
      const auto strip = [&](const double from_tip) {
        std::vector<ContactCell> cells;
        for (int s = 0; s < slices; ++s)
          for (int c = 0; c < across; ++c)
            {
              const double x = (2 * c + 1 - across) * half_profile, y = (2 * s + 1 - slices) * half_generator;
              const auto at = [&](const Gear &of, const double middle, const double along) {
                return Patch{ .tooth = 0,
                              .outline = {},
                              .roll = std::sqrt(middle * middle + 2 * along / of.base_radius) +
                                      y * of.flank().roll_per_generator(),
                              .z = y * of.flank().cos_base_helix(),
                              .half_profile = half_profile,
                              .half_generator = half_generator };
              };
              ContactCell cell{};
              cell.slice = s;
              cell.pinion =
                  at(gear, std::sqrt(gear.tip_roll * gear.tip_roll - 2 * from_tip / gear.base_radius), x);
              cell.gear = at(pair.gear, std::tan(20 * degree), -x);
              cell.area = 4 * half_profile * half_generator;
              cell.place = CellPlace::inside;
              cells.push_back(cell);
            }
        return cells;
      };
      Eigen::VectorXd force(slices * across), pressure(slices * across);
      for (Eigen::Index i = 0; i < force.size(); ++i)
        {
          const double x = (2 * static_cast<double>(i % across) + 1 - across) / across;
          pressure[i] = peak * std::sqrt(1 - x * x) * (i / across == slices / 2 ? 1.01 : 1.0);
          force[i] = pressure[i] * 4 * half_profile * half_generator;
        }
      const EdgesOfPair edges(pair);
      const double from_tip =
          0.5 * std::hypot(1, gear.base_radius * gear.tip_roll * gear.flank().roll_per_generator());
      const std::vector<ContactCell> near = strip(from_tip), far = strip(1.6);
      const auto found = below_greatest_pressure(pair, &edges, near, force, pressure),
                 unaware = below_greatest_pressure(pair, nullptr, near, force, pressure),
                 inside = below_greatest_pressure(pair, &edges, far, force, pressure);
      EXPECT_GT(found.shear, 1.02 * inside.shear) << helix; // less steel holds it
      EXPECT_NEAR(unaware.shear, inside.shear, 0.01 * inside.shear) << helix;
      // The same sum, of the cell's forces in nine points each.
      const auto own = [&](const Eigen::Vector2d &at, const double depth) {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        const InvoluteHelicoid flank = gear.flank();
        const std::size_t most = (slices / 2) * across + across / 2;
        for (std::size_t i = 0; i < near.size(); ++i)
          {
            const Patch &patch = near[i].pinion;
            const Eigen::Vector2d middle = patch.seen_from(near[most].pinion, flank);
            for (int p = -1; p <= 1; ++p)
              for (int q = -1; q <= 1; ++q)
                {
                  const double dx = p * half_profile * 2 / 3, dy = q * half_generator * 2 / 3;
                  const FlankEdges::Place place{ patch.roll + dx / (gear.base_radius * patch.roll) +
                                                     dy * flank.roll_per_generator(),
                                                 patch.z + dy * flank.cos_base_helix() };
                  const Eigen::Vector3d x(at.x() - middle.x() - dx, at.y() - middle.y() - dy, depth);
                  sum += force[static_cast<Eigen::Index>(i)] / 9 *
                         edges.pinion.added_stress(FlankEdge::tip, place, x);
                }
            sum += force[static_cast<Eigen::Index>(i)] *
                   half_space::love_stress(half_profile, half_generator,
                                           { at.x() - middle.x(), at.y() - middle.y(), depth },
                                           gear.poissons_ratio);
          }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(sum);
        return 0.5 * (principal.eigenvalues()[2] - principal.eigenvalues()[0]);
      };
      double greatest = 0;
      for (int c = 0; c < across; ++c)
        greatest = std::max(greatest, own({ (2 * c - across) * half_profile, 0 }, found.shear_depth));
      EXPECT_NEAR(found.shear, greatest, 0.01 * greatest) << helix;
    }
}

TEST(StressBelowContact, WithoutPoissonsRatioAnEndIsLikeTheMiddle)
{
  // A line contact over the whole face. Without lateral contraction its slices are alike, and free ends leave
  // them as they are; half of the half-space's load is missing there.
  PairData data = paper_pair(0);
  data.pinion.poissons_ratio = data.gear.poissons_ratio = 0;
  const GearPair pair = make_gear_pair(data);
  constexpr int slices = 40, across = 16;
  constexpr double half_width = 0.2, peak = 1000, half_generator = 10.0 / slices,
                   half_profile = half_width / across;
  const double roll = std::tan(20 * degree);
  std::vector<ContactCell> cells;
  Eigen::VectorXd force(slices * across), pressure(slices * across);
  for (int s = 0; s < slices; ++s)
    for (int c = 0; c < across; ++c)
      {
        const double x = (2 * c + 1 - across) * half_profile, z = -10 + (2 * s + 1) * half_generator;
        const auto at = [&](const Gear &gear, const double along, const double axial) {
          return Patch{ .tooth = 0,
                        .outline = {},
                        .roll = std::sqrt(roll * roll + 2 * along / gear.base_radius),
                        .z = axial,
                        .half_profile = half_profile,
                        .half_generator = half_generator };
        };
        ContactCell cell{};
        cell.slice = s;
        cell.pinion = at(pair.pinion, x, z);
        cell.gear = at(pair.gear, -x, -z);
        cell.area = 4 * half_profile * half_generator;
        cell.place = CellPlace::inside;
        const auto i = static_cast<Eigen::Index>(cells.size());
        pressure[i] = peak * std::sqrt(1 - x * x / (half_width * half_width));
        force[i] = pressure[i] * cell.area;
        cells.push_back(cell);
      }
  const EdgesOfPair ends(pair);
  const auto below = [&](const int slice, const EdgesOfPair *of) {
    Eigen::VectorXd most = pressure;
    most.segment(slice * across, across) *= 1.01; // tells where to look
    return below_greatest_pressure(pair, of, cells, force, most);
  };
  const auto middle = below(slices / 2, &ends), unaware = below(slices / 2, nullptr);
  EXPECT_NEAR(middle.shear, 0.5 * peak,
              0.02 * 0.5 * peak);         // at the surface: pressed alike but along the line
  EXPECT_EQ(middle.shear, unaware.shear); // no end is near
  for (const int slice : { 0, 1, slices - 1 })
    {
      const auto end = below(slice, &ends);
      EXPECT_NEAR(end.shear, middle.shear, 0.02 * middle.shear) << slice;
      EXPECT_NEAR(end.von_mises, middle.von_mises, 0.02 * middle.von_mises) << slice;
    }
  EXPECT_GT(std::abs(below(0, nullptr).shear - middle.shear), 0.05 * middle.shear);
}
