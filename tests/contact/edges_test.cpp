// SPDX-License-Identifier: GPL-2.0-or-later
// Edges of flanks: where the pressure has a limit and is found with its grid, where it has none.
#include "contact/flanks/tip_edges.hpp"
#include "contact/loaded/stress_below_contact.hpp"
#include "contact/wedge/edge_exponent.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

using namespace flank;
using units::degree;

namespace
{
  /// Power of the pressure at the end of a body of this opening [deg] on one that goes on.
  double power_on_a_longer_one(const double opening)
  {
    return wedge::pressure_exponent({ opening * degree, 1 }, { units::pi, 1 });
  }

  /// A pair turned in the plane of action by an angle, with tips relieved so far that they do not touch.
  MeshDeviations relieved(const GearPair &pair, const double in_plane = 0)
  {
    MeshDeviations deviations;
    deviations.misalignment.in_plane = in_plane;
    deviations.pinion.modifications = deviations.gear.modifications = { std::make_shared<ProfileRelief>(
        "tip relief", 60e-3, 22 * degree, pair.pinion.tip_roll, ReliefShape::quadratic,
        pair.pinion.base_radius) };
    return deviations;
  }

  int slices_at(const PositionResult &result, const CellPlace place)
  {
    std::set<std::pair<int, double>> slices;
    for (const GridCell &cell : *result.grid_cells)
      if (cell.place == place)
        slices.insert({ cell.pair, cell.z });
    return static_cast<int>(slices.size());
  }
} // namespace

TEST(FaceEnds, AreSharpWhereOneGearEndsOnTheOther)
{
  const double right_angle = power_on_a_longer_one(90);
  ASSERT_LT(right_angle, -0.2);
  PairData spur = paper_pair(0);
  const auto powers = [&] { return end_powers(make_gear_pair(spur)); };
  EXPECT_EQ(powers(), (std::array{ 0.0, 0.0 })); // both end there
  spur.gear.face_width = 24;
  EXPECT_EQ(powers(), (std::array{ right_angle, right_angle }));
  spur.axial_offset = 2; // the ends at +z are common, the pinion's at -z stands alone
  spur.gear.face_width = 16;
  EXPECT_EQ(powers(), (std::array{ right_angle, 0.0 }));
  spur.axial_offset = -2;
  EXPECT_EQ(powers(), (std::array{ 0.0, right_angle }));
  spur.pinion.youngs_modulus = 1e12; // a rigid punch
  EXPECT_NEAR(powers()[1], wedge::pressure_exponent({ units::pi / 2, 1 }, { units::pi, 1e9 }), 1e-6);
}

TEST(FaceEnds, OfHelicalGearsAreAcuteAndObtuse)
{
  PairData data = paper_pair(25.232);
  EXPECT_EQ(end_powers(make_gear_pair(data)), (std::array{ 0.0, 0.0 }));
  data.gear.face_width = 24;
  const GearPair pair = make_gear_pair(data);
  // The outward normal of a flank of the right-hand pinion, against the end planes' +-z.
  const double lean = std::asin(std::abs(std::sin(pair.base_helix_angle))) / degree;
  const auto [low, high] = end_powers(pair);
  EXPECT_NEAR(std::min(low, high), power_on_a_longer_one(90 + lean), 1e-9);
  EXPECT_NEAR(std::max(low, high), std::min(0.0, power_on_a_longer_one(90 - lean)), 1e-9);
  // Whichever gear ends, the other hand and drive are mirror images: the same in the canonical frame.
  for (const Hand hand : { Hand::right, Hand::left })
    for (const bool counter_clockwise : { false, true })
      {
        data.pinion_hand = hand;
        data.counter_clockwise_drive = counter_clockwise;
        EXPECT_EQ(end_powers(make_gear_pair(data)), (std::array{ low, high }));
      }
  // On the gear the same plane cuts the other side of the contact: acute and obtuse change places.
  std::swap(data.pinion.face_width, data.gear.face_width);
  EXPECT_EQ(end_powers(make_gear_pair(data)), (std::array{ high, low }));
}

TEST(FaceEnds, PressureAtACommonEndConverges)
{
  // Tilted until the ends at -z carry most: the greatest pressure lies beside them.
  const GearPair pair = make_gear_pair(paper_pair(0));
  const auto pressed = [&](const int slices) {
    return mesh_of(pair, relieved(pair, 60e-3 / 20), {}, {}, slices).solve(0, { 100e3 })[0];
  };
  const PositionResult coarse = pressed(15), fine = pressed(61);
  EXPECT_EQ(fine.edge_pressure, 0);
  EXPECT_GT(std::abs(coarse.max_pressure_z), 9.5); // in a slice that was not there before: 20/15 mm long
  EXPECT_NEAR(coarse.max_pressure, fine.max_pressure, 0.02 * fine.max_pressure);
  EXPECT_EQ(coarse.end_intensity, 0);
  EXPECT_GT(slices_at(coarse, CellPlace::finite_end), 0);
  EXPECT_EQ(slices_at(coarse, CellPlace::face_end), 0);
}

TEST(FaceEnds, IntensityAtASharpEndConvergesWherePressureDoesNot)
{
  PairData data = paper_pair(0);
  data.gear.face_width = 24;
  const GearPair pair = make_gear_pair(data);
  const BodyCompliance gear(pair.gear, small_sector(), 6);
  const MeshDeviations deviations = relieved(pair, 30e-3 / 20);
  const auto pressed = [&](const int slices) {
    return small_loaded_pair(pair, small_body(0), gear, deviations, { slices, 11 }).solve(0, { 200e3 })[0];
  };
  const PositionResult coarse = pressed(15), fine = pressed(121);
  EXPECT_GT(fine.edge_pressure, 1.1 * coarse.edge_pressure);
  EXPECT_NEAR(fine.end_intensity, coarse.end_intensity, 0.07 * fine.end_intensity);
  EXPECT_EQ(fine.end_power, power_on_a_longer_one(90));
  EXPECT_GT(slices_at(fine, CellPlace::face_end), 0);
  EXPECT_EQ(slices_at(fine, CellPlace::finite_end), 0);
}

TEST(FaceEnds, HalfSpacesAreSingularWhereTheContactIsCutOff)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  NearField near;
  near.free_ends = false;
  const BodyCompliance body(pair.pinion, small_sector(), 6, near);
  const PositionResult result =
      small_loaded_pair(pair, body, body, relieved(pair, 60e-3 / 20), { 15, 11 }).solve(0, { 100e3 })[0];
  EXPECT_GT(result.edge_pressure, 0);
  EXPECT_EQ(result.end_power, -0.5);
  EXPECT_EQ(slices_at(result, CellPlace::finite_end), 0);
}

TEST(FaceEnds, BothEndsAreAlike)
{
  // Hollow flanks carry at both ends: neither is halved before the other, whatever rounding says.
  const GearPair pair = make_gear_pair(paper_pair(0));
  MeshDeviations hollow = relieved(pair);
  hollow.pinion.modifications.push_back(std::make_shared<LeadCrown>(-20e-3, 20));
  const PositionResult result = mesh_of(pair, hollow, {}, {}, 31).solve(0, { 100e3 })[0];
  EXPECT_GT(std::abs(result.max_pressure_z), 9.5);
  EXPECT_NEAR(result.load_centre, 0, 1e-9);
}

TEST(FaceEnds, WhereSharpEdgesAloneCarryNothingIsHalved)
{
  // The tooth before the one that stands back takes the load with its tip edge alone.
  const GearPair pair = make_gear_pair(paper_pair(0));
  MeshDeviations bad;
  bad.pinion.index_errors.assign(50, 0);
  bad.pinion.index_errors[0] = -22e-3;
  for (int k = 0; k < 16; ++k)
    {
      const PositionResult result = mesh_of(pair, bad, {}, {}, 7).solve(k / 16.0, { 100e3 })[0];
      EXPECT_TRUE(result.certificate.holds());
      EXPECT_LT(result.grid_cells->size(), 11U * 7 * 5) << k; // of no more slices than five pairs have
    }
}

TEST(FaceEnds, SlicesStayWhereEndsDoNotCarryTheMost)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const PositionResult level = mesh_of(pair, relieved(pair)).solve(0, { 100e3 })[0];
  std::set<double> heights;
  for (const LineLoad &line : level.lines)
    heights.insert(std::round(1e9 * line.height));
  EXPECT_EQ(heights.size(), 1U);
}

// A level pair that carries somewhat less than the one beside it: its ends do not press more than its middle.
TEST(FaceEnds, SlicesStayWhereAPairCarriesLess)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const auto mesh = mesh_of(pair, {});
  double nearest = 1; // of pressures of both pairs, from 0.93
  for (double phase = 0; phase < 0.6; phase += 0.01)
    {
      const PositionResult result = mesh.solve(phase, { 20e3 })[0];
      std::map<int, double> greatest, height;
      for (const LineLoad &line : result.lines)
        {
          greatest[line.pair] = std::max(greatest[line.pair], line.max_pressure);
          height.emplace(line.pair, line.height);
          EXPECT_NEAR(line.height, height[line.pair], 1e-9) << phase << ' ' << line.pair << ' ' << line.z;
        }
      if (greatest.size() == 2 && result.edge_pressure == 0)
        {
          const double one = greatest.begin()->second, other = greatest.rbegin()->second;
          nearest = std::min(nearest, std::abs(std::min(one, other) / std::max(one, other) - 0.93));
        }
    }
  EXPECT_LT(nearest, 0.02);
}

TEST(RoundedTip, PressureConverges)
{
  // The incoming tooth meets the tip of the gear beyond the path of action.
  const auto pressed = [](const double rounding, const double phase, const int across) {
    PairData data = paper_pair(0);
    data.pinion.tip_rounding = data.gear.tip_rounding = rounding;
    const GearPair pair = make_gear_pair(data);
    return small_loaded_pair(pair, small_body(0), small_body(0), {}, { 7, across })
        .solve(phase, { 200e3 })[0];
  };
  const PositionResult coarse = pressed(0.3, 0.125, 21), fine = pressed(0.3, 0.125, 61);
  EXPECT_GT(slices_at(fine, CellPlace::rounded_tip), 0);
  EXPECT_EQ(slices_at(fine, CellPlace::tip_edge), 0);
  EXPECT_GT(fine.tip_edge_load, 0);
  EXPECT_NEAR(coarse.max_pressure, fine.max_pressure, 0.02 * fine.max_pressure);
  // Sharp ones carry alike, but their pressure has no limit.
  const PositionResult sharp = pressed(0, 0.09375, 21), finer = pressed(0, 0.09375, 61);
  EXPECT_GT(sharp.tip_edge_load, 0);
  EXPECT_GT(finer.edge_pressure, 1.2 * sharp.edge_pressure);
  EXPECT_LT(finer.max_pressure, 0.5 * fine.max_pressure);
}

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

TEST(TipEdges, OpenByTheirAngles)
{
  for (const double helix : { 0.0, 25.232 })
    {
      PairData data = paper_pair(helix);
      const GearPair plain = make_gear_pair(data);
      // Between the flank's normal and the radius, which the tip land's is.
      const Gear &gear = plain.pinion;
      const double lean = std::cos(gear.base_helix_angle) * std::sin(std::atan(gear.tip_roll));
      EXPECT_NEAR(opening_at_tip(gear), units::pi / 2 + std::asin(lean), 1e-12) << helix;
      const wedge::EndOfContact tip{ opening_at_tip(gear), 1 };
      EXPECT_EQ(tip_powers(plain)[0], wedge::pressure_exponent(tip, { units::pi, 1 })) << helix;
      EXPECT_EQ(tip_powers(plain, EndsOfFlanks::half_space), (std::array{ -0.5, -0.5 }));
      data.gear.tip_chamfer = 0.5;
      const GearPair chamfered = make_gear_pair(data);
      EXPECT_EQ(tip_powers(chamfered)[0], tip_powers(plain)[0]);
      EXPECT_LT(tip_powers(chamfered)[1], tip_powers(plain)[1] - 0.02); // blunter: nearer to a flat punch
      data.gear.tip_chamfer = 0, data.gear.tip_rounding = 0.2;
      EXPECT_EQ(tip_powers(make_gear_pair(data))[1], 0);
    }
  PairData data = paper_pair(0);
  data.pinion.tip_chamfer = 0.5;
  const Gear spur = make_gear_pair(data).pinion;
  EXPECT_NEAR(opening_at_tip(spur), 0.75 * units::pi + std::atan(spur.usable_tip_roll), 1e-12);
}

TEST(TipEdges, IntensityConvergesWherePressureDoesNot)
{
  struct Scene
  {
    double helix, phase, allowed; ///< what the intensity may change by: cells of helical gears are cut there
  };
  for (const auto &[helix, phase, allowed] :
       { Scene{ 0, 0.1, 0.005 }, { 0, 0.93, 0.005 }, { 25.232, 0.13, 0.04 }, { 25.232, 0.05, 0.08 } })
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      const BodyCompliance &body = small_body(helix);
      const auto pressed = [&, phase = phase](const int cells) {
        return small_loaded_pair(pair, body, body, {}, { 15, cells }).solve(phase, { 300e3 })[0];
      };
      const PositionResult coarse = pressed(11), fine = pressed(41);
      EXPECT_GT(fine.edge_pressure, (helix == 0 ? 2.5 : 0.9) * coarse.edge_pressure) << phase;
      EXPECT_NEAR(coarse.tip_intensity, fine.tip_intensity, allowed * fine.tip_intensity) << phase;
      EXPECT_GT(fine.tip_intensity, 0);
      EXPECT_EQ(fine.tip_power, tip_powers(pair)[0]);
    }
}
