// SPDX-License-Identifier: GPL-2.0-or-later
// Edges of flanks: where the pressure has a limit and is found with its grid, where it has none.
#include "contact/flanks/tip_edges.hpp"
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
