// SPDX-License-Identifier: GPL-2.0-or-later
// Modifications, deviations, misalignment and mounting: formulas, rigid flanks in closed form, loaded identities.
#include "cases/harmonics.hpp"
#include "cases/parallel_axis/report/load_distribution.hpp"
#include "cases/parallel_axis/mesh_cycle.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/topography.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace flank;
using units::degree;
using units::micrometre;

namespace
{
  constexpr ContactGridSize small_grid{ 15, 11 };

  /// A draft mesh: the identities tested here hold for any.
  const BodyCompliance &body(const double helix)
  {
    const auto make = [](const double h) {
      SectorResolution size;
      size.flank_rows = 6, size.tooth_columns = 4, size.face_layers = 6, size.rim_layers = 5;
      return BodyCompliance(make_gear_pair(paper_pair(h)).pinion, size, 6, Split::projected, ClassicalDepth::half_element);
    };
    static const BodyCompliance spur = make(0), helical = make(25.232);
    return helix == 0 ? spur : helical;
  }

  LoadedMesh mesh_of(const GearPair &pair, const MeshDeviations &deviations = {}, const Mounting &pinion = {}, const Mounting &gear = {},
                     const int slices = small_grid.slices)
  {
    const BodyCompliance &b = body(pair.data.helix_angle);
    return { { pair, b, b, { slices, 11 }, pinion, gear }, deviations };
  }

  MeshDeviations on_pinion(std::shared_ptr<const FlankModification> modification)
  {
    MeshDeviations deviations;
    deviations.pinion.modifications = { std::move(modification) };
    return deviations;
  }

  MeshDeviations on_gear(std::shared_ptr<const FlankModification> modification)
  {
    MeshDeviations deviations;
    deviations.gear.modifications = { std::move(modification) };
    return deviations;
  }

  double te(const GearPair &pair, const PositionResult &result)
  {
    return transmission_error_um(pair, result);
  }

  /// Peak amplitude of the first mesh harmonic over eight positions. [um]
  double first_harmonic(const LoadedMesh &mesh, const double torque, const int positions = 8)
  {
    std::vector<double> values;
    for (int k = 0; k < positions; ++k)
      values.push_back(te(mesh.bodies.pair, mesh.solve(1.0 * k / positions, { torque })[0]));
    return harmonics(values)[0].amplitude;
  }

  /// Least gap of rigid flanks over the plane of action, along the line of action [mm]: sampled without the scene's code.
  /// In the canonical frame (right hand, counter-clockwise).
  template <class Gap>
  double rigid_error(const GearPair &pair, const double phase, const Gap &normal_gap)
  {
    double least = 1e9;
    for (int k = -3; k <= 3; ++k)
      for (int i = 0; i <= 4000; ++i)
        {
          const double z    = -10 + i * 0.005,
                       roll = std::tan(20 * degree) + (phase + k) * 2 * units::pi / 50 + z * std::tan(pair.data.helix_angle) / 75,
                       mate = 2 * std::tan(20 * degree) - roll;
          if (roll <= pair.pinion.tip_roll && mate <= pair.gear.tip_roll)
            least = std::min(least, normal_gap(roll, mate, z) / std::cos(pair.base_helix_angle));
        }
    return least;
  }

  /// The pair of the helical example with its flanks replaced by `flanks`.
  ParallelAxisCase read(const std::string &flanks, const std::vector<std::string> &settings = {},
                        const std::string &gear = "like = \"pinion\"")
  {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "flank_deviation_test.toml";
    std::ofstream(path) << R"(scene = "parallel_axis"
[pair]
centre_distance_mm = 150.0
transverse_module_mm = 3.0
transverse_pressure_angle_deg = 20.0
helix_angle_deg = 25.232
[load]
pinion_torque_Nm = [100]
[pinion]
teeth = 50
face_width_mm = 20.0
tip_diameter_mm = 156.0
root_diameter_mm = 140.68
tooth_thickness_mm = 4.64
bore_diameter_mm = 70.34
fillet_radius_mm = 1.0
youngs_modulus_GPa = 207.0
poissons_ratio = 0.3
)" << flanks << "\n[gear]\n"
                        << gear << "\n";
    return read_parallel_axis(CaseFile::read(path.string(), settings));
  }

  std::string refusal(const std::string &flanks, const std::vector<std::string> &settings = {},
                      const std::string &gear = "like = \"pinion\"")
  {
    try
      {
        read(flanks, settings, gear);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }

  bool holds(const std::string &text, const std::vector<std::string> &parts)
  {
    for (const std::string &part : parts)
      if (text.find(part) == std::string::npos)
        return false;
    return text.find('\n') == std::string::npos;
  }

  void write_table(const std::string &name, const std::string &content)
  {
    std::ofstream(std::filesystem::path(testing::TempDir()) / name) << content;
  }
} // namespace

TEST(Modification, EachByItsFormula)
{
  const ProfileSlope slope(8e-3, 0.25, 0.45);
  EXPECT_NEAR(slope.removed(0.25, 3), -4e-3, 1e-15);
  EXPECT_NEAR(slope.removed(0.45, 3), 4e-3, 1e-15);
  EXPECT_NEAR(slope.removed(0.40, -7), 2e-3, 1e-15);
  const ProfileCrown crown(6e-3, 0.25, 0.45);
  EXPECT_NEAR(crown.removed(0.25, 0), 6e-3, 1e-15);
  EXPECT_NEAR(crown.removed(0.35, 0), 0, 1e-15);
  EXPECT_NEAR(crown.removed(0.40, 0), 1.5e-3, 1e-15);
  const LeadCrown lead(4e-3, 20);
  EXPECT_NEAR(lead.removed(0.3, -10), 4e-3, 1e-15);
  EXPECT_NEAR(lead.removed(0.3, 5), 1e-3, 1e-15);
  const HelixSlope helix(10e-3, 20);
  EXPECT_NEAR(helix.removed(0.3, 10), 5e-3, 1e-15);
  EXPECT_NEAR(helix.removed(0.3, -4), -2e-3, 1e-15);
  const EndRelief both(12e-3, 4, 20, 0, ReliefShape::linear), high(12e-3, 4, 20, 1, ReliefShape::quadratic);
  EXPECT_NEAR(both.removed(0.3, -10), 12e-3, 1e-15);
  EXPECT_NEAR(both.removed(0.3, 9), 9e-3, 1e-15);
  EXPECT_NEAR(both.removed(0.3, 6), 0, 1e-15);
  EXPECT_NEAR(high.removed(0.3, 8), 3e-3, 1e-15);
  EXPECT_NEAR(high.removed(0.3, -10), 0, 1e-15);
  const ProfileRelief tip("tip relief", 10e-3, 0.35, 0.45, ReliefShape::quadratic),
      root("root relief", 10e-3, 0.30, 0.25, ReliefShape::linear);
  EXPECT_NEAR(tip.removed(0.40, 0), 2.5e-3, 1e-15);
  EXPECT_NEAR(root.removed(0.26, 0), 8e-3, 1e-15);
  EXPECT_EQ(root.removed(0.31, 0), 0);
}

TEST(Modification, BiasCornersByTheirFormula)
{
  // Corner at the tip and -z, 5 um, from roll 0.3 at the face end to 10 mm along the tip (roll 0.5); b = 20 mm.
  for (const auto &[shape, power] : { std::pair{ ReliefShape::linear, 1 }, { ReliefShape::quadratic, 2 } })
    {
      const CornerBias bias(1, 5e-3, 0.3, 0.5, 10, 20, -1, shape);
      EXPECT_NEAR(bias.removed(0.5, -10), 5e-3, 1e-15);
      EXPECT_NEAR(bias.removed(0.3, -10), 0, 1e-15);
      EXPECT_NEAR(bias.removed(0.5, 0), 0, 1e-15);
      EXPECT_NEAR(bias.removed(0.4, -5), 0, 1e-15); // on the line u = v
      EXPECT_NEAR(bias.removed(0.45, -8), 5e-3 * std::pow(0.75 - 0.2, power), 1e-15);
      EXPECT_EQ(bias.removed(0.5, 10), 0);
    }
  const CornerBias root(3, 5e-3, 0.35, 0.25, 10, 20, 1, ReliefShape::linear);
  EXPECT_NEAR(root.removed(0.25, 10), 5e-3, 1e-15);
  EXPECT_NEAR(root.removed(0.25, 0), 0, 1e-15);
  EXPECT_NEAR(root.removed(0.30, 9), 5e-3 * (0.5 - 0.1), 1e-15);
}

TEST(Modification, UnloadedTransmissionErrorIsTheGeometricOne)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const double   sap = pair.pinion_roll.start_of_active_profile, tip = pair.pinion_roll.tip;
  using Pointer = std::shared_ptr<const FlankModification>;
  for (const Pointer &modification :
       { Pointer(std::make_shared<ProfileSlope>(6e-3, sap, tip)), Pointer(std::make_shared<ProfileCrown>(6e-3, sap, tip)),
         Pointer(std::make_shared<LeadCrown>(4e-3, 20)), Pointer(std::make_shared<HelixSlope>(6e-3, 20)),
         Pointer(std::make_shared<EndRelief>(5e-3, 6, 20, 0, ReliefShape::quadratic)),
         Pointer(std::make_shared<CornerBias>(1, 5e-3, 0.27, tip, 20, 20, -1, ReliefShape::linear)),
         Pointer(std::make_shared<CornerBias>(4, 5e-3, 0.44, sap, 20, 20, -1, ReliefShape::quadratic)) })
    for (const double phase : { 0.0, 0.3, 0.7 })
      {
        const double of_pinion = rigid_error(pair, phase, [&](double roll, double, double z) { return modification->removed(roll, z); }),
                     of_gear   = rigid_error(pair, phase, [&](double, double mate, double z) { return modification->removed(mate, z); });
        // Sections 0.33 mm apart; contact moves off the path where the surface slopes: slope^2 R/2 < 3e-5 mm.
        EXPECT_NEAR(mesh_of(pair, on_pinion(modification)).unloaded(phase).theta * pair.pinion.base_radius, of_pinion, 6e-5)
            << modification->describe(pair.pinion.base_radius);
        EXPECT_NEAR(mesh_of(pair, on_gear(modification)).unloaded(phase).theta * pair.pinion.base_radius, of_gear, 6e-5)
            << modification->describe(pair.pinion.base_radius);
      }
}

TEST(Modification, SlopeOnThePinionIsTheOppositeOnTheGear)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const double   sap = pair.pinion_roll.start_of_active_profile, tip = pair.pinion_roll.tip;
  // Profile: the pinion's tip meets the gear's root. Along z both are given on the same axis, so the same amount opens the same gap;
  // as a deviation of the helix angle that is the opposite one, and the gears of one drawing (mirrored by `like`) cancel.
  const GearPair spur = make_gear_pair(paper_pair(0)); // one pair alone, on the path of action: outside it facing points differ
  const double   a    = te(spur, mesh_of(spur, on_pinion(std::make_shared<ProfileSlope>(1e-3, sap, tip))).solve(0.03, { 10e3 })[0]),
               b      = te(spur, mesh_of(spur, on_gear(std::make_shared<ProfileSlope>(-1e-3, sap, tip))).solve(0.03, { 10e3 })[0]);
  EXPECT_NEAR(a, b, 1e-3); // um
  const double c = te(pair, mesh_of(pair, on_pinion(std::make_shared<HelixSlope>(8e-3, 20))).solve(0.3, { 150e3 })[0]),
               d = te(pair, mesh_of(pair, on_gear(std::make_shared<HelixSlope>(8e-3, 20))).solve(0.3, { 150e3 })[0]);
  EXPECT_NEAR(c, d, 1e-9);
  const double plain = te(pair, mesh_of(pair).solve(0.3, { 150e3 })[0]);
  EXPECT_GT(std::abs(c - plain), 0.05);
  const ParallelAxisCase same = read("helix_slope = { amount_um = 8 }");
  EXPECT_NEAR(te(pair, mesh_of(pair, same.deviations).solve(0.3, { 150e3 })[0]), plain,
              1e-6); // um; widths follow the touching points, found to 1e-6
}

TEST(Bias, CornerBelongsToTheEndOfTheContactLines)
{
  // Sections of a right-hand helix at +z are turned counter-clockwise, so they are ahead when the pinion turns that way: contact
  // leaves the tip last at -z. Left hand, or turning clockwise: at +z. The driven gear's corner 1 is where contact enters at its tip.
  for (const bool right : { true, false })
    for (const bool counter : { true, false })
      {
        const ParallelAxisCase input  = read("bias = [ { corner = 1, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]",
                                             { std::string("pair.pinion_hand=") + (right ? "right" : "left"),
                                               std::string("load.drive_flank=") + (counter ? "counter_clockwise" : "clockwise") });
        const double           leaves = right == counter ? -10 : 10, tip = input.pair.pinion.tip_roll;
        EXPECT_NEAR(removed(input.deviations.pinion.modifications, tip, leaves), 5e-3, 1e-12);
        EXPECT_EQ(removed(input.deviations.pinion.modifications, tip, -leaves), 0);
        EXPECT_NEAR(removed(input.deviations.gear.modifications, tip, -leaves), 5e-3, 1e-12);
        EXPECT_EQ(removed(input.deviations.gear.modifications, tip, leaves), 0);
      }
}

TEST(Bias, OutHarmsAtEveryTorqueAndInDoesNot)
{
  const GearPair pair  = make_gear_pair(paper_pair(25.232));
  const auto     flank = [&](const int corner) {
    return read("bias = [ { corner = " + std::to_string(corner) + ", amount_um = 5, start_roll_angle_deg = 15, length_mm = 20 } ]")
        .deviations;
  };
  const LoadedMesh plain = mesh_of(pair), in = mesh_of(pair, flank(1)), out = mesh_of(pair, flank(2)), root_in = mesh_of(pair, flank(3));
  for (const double torque : { 100e3, 250e3 })
    {
      const double a = first_harmonic(plain, torque), b = first_harmonic(in, torque), c = first_harmonic(out, torque);
      EXPECT_GT(c, 1.5 * a) << torque;
      EXPECT_LT(b, a) << torque;
      EXPECT_LT(first_harmonic(root_in, torque), a) << torque; // corner 3 is bias-in too
    }
}

TEST(Bias, AtHelixZeroTheLimitOfARightHandPinion)
{
  const ParallelAxisCase input = read("bias = [ { corner = 2, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]",
                                      { "pair.helix_angle_deg=0", "pair.pinion_hand=left" });
  EXPECT_NEAR(removed(input.deviations.pinion.modifications, input.pair.pinion.tip_roll, 10), 5e-3, 1e-12);
}

TEST(Mirror, MirroredCaseGivesMirroredMapsAndTheSameTransmissionError)
{
  const std::string flanks   = "helix_slope = { amount_um = 4 }\nend_relief = { amount_um = 3, length_mm = 5, end = \"positive_z\" }\n"
                               "bias = [ { corner = 2, amount_um = 5, start_roll_angle_deg = 16, length_mm = 15 } ]",
                    mirrored = "helix_slope = { amount_um = -4 }\nend_relief = { amount_um = 3, length_mm = 5, end = \"negative_z\" }\n"
                               "bias = [ { corner = 2, amount_um = 5, start_roll_angle_deg = 16, length_mm = 15 } ]";
  const ParallelAxisCase a   = read(flanks, { "misalignment.in_plane_um=6" }),
                         b   = read(mirrored, { "pair.pinion_hand=left", "misalignment.in_plane_um=-6" });
  for (const auto map : { pinion_modification, gear_modification, sum_of_modifications })
    EXPECT_LT((map(a.pair, a.deviations).value - map(b.pair, b.deviations).value.rowwise().reverse()).cwiseAbs().maxCoeff(), 1e-12);
  const PositionResult x = mesh_of(a.pair, a.deviations).solve(0.3, { 150e3 })[0],
                       y = mesh_of(b.pair, b.deviations).solve(0.3, { 150e3 })[0];
  EXPECT_NEAR(te(a.pair, x), te(b.pair, y), 1e-9);
  EXPECT_NEAR(x.load_centre, -y.load_centre, 1e-9);
  const Eigen::MatrixXd p = contact_pattern(a.pair, { x }, 15).value, q = contact_pattern(b.pair, { y }, 15).value;
  EXPECT_GT(p.maxCoeff(), 100);
  EXPECT_LT((p - q.rowwise().reverse()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Topography, SampledFormulaIsTheFormulaToItsInterpolationError)
{
  std::vector<double> roll, z;
  const auto          table = [&](const int n, const auto &formula) {
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
    return Topography("table", roll, z, values);
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
  const auto quadratic = [](double r, double w) { return 5e-3 * (r - 0.3) * (r - 0.3) + 1e-5 * w * w - 2e-4 * w * r; };
  EXPECT_LT(worst(table(6, quadratic), quadratic), 1e-15); // parabolas are reproduced
  const auto   wave   = [](double r, double w) { return 5e-3 * std::sin(20 * r) * std::cos(0.3 * w); };
  const double coarse = worst(table(11, wave), wave), fine = worst(table(21, wave), wave);
  EXPECT_LT(fine, coarse / 5.5); // third order: 8, less at the uneven ends
  EXPECT_LT(fine, 2e-5);
  // Once continuously differentiable: the slope does not jump at a node.
  const Topography t    = table(11, wave);
  const double     node = roll[5], h = 1e-7;
  EXPECT_NEAR((t.removed(node + h, 1.3) - t.removed(node, 1.3)) / h, (t.removed(node, 1.3) - t.removed(node - h, 1.3)) / h, 1e-6);
}

TEST(Topography, TableOfReliefAndCrownActsLikeThem)
{
  const GearPair      pair = make_gear_pair(paper_pair(25.232));
  const auto          deg  = [](const double d) { return d * degree; };
  const ProfileRelief relief("tip relief", 10e-3, deg(20.9), pair.pinion.tip_roll, ReliefShape::quadratic);
  const LeadCrown     crown(4e-3, 20);
  for (const std::string axis : { "roll_angle_deg", "diameter_mm", "length_of_roll_mm" })
    {
      std::string table = "# measured nowhere\nremoved_um(" + axis + ",z_mm)";
      for (int j = 0; j <= 10; ++j)
        table += "," + std::to_string(-10 + 2 * j);
      for (int i = 0; i <= 26; ++i)
        {
          const double roll = deg(14.2 + 0.5 * i);
          table += "\n" + std::to_string(axis == "roll_angle_deg" ? roll / degree
                                         : axis == "diameter_mm"  ? 2 * radius_at_roll(roll, pair.pinion.base_radius)
                                                                  : roll * pair.pinion.base_radius);
          for (int j = 0; j <= 10; ++j)
            table += "," + std::to_string((relief.removed(roll, 0) + crown.removed(0, -10 + 2.0 * j)) / micrometre);
        }
      write_table("formula.csv", table + "\n");
      const ParallelAxisCase
          a = read("topography = { file = \"formula.csv\" }"),
          b = read("tip_relief = { amount_um = 10, start_roll_angle_deg = 20.9, shape = \"quadratic\" }\nlead_crown = { amount_um = 4 }");
      // The kink of curvature at the start leaves h^2 times its jump / 32: (0.5 deg)^2 10 um / (6.27 deg)^2 / 16 = 4e-3 um.
      for (const double roll : { 15.0, 20.0, 20.9, 21.3, 25.77, 27.0 })
        for (const double z : { -9.7, 0.0, 3.33 })
          EXPECT_NEAR(removed(a.deviations.pinion.modifications, deg(roll), z), removed(b.deviations.pinion.modifications, deg(roll), z),
                      1e-5);
      EXPECT_NEAR(te(pair, mesh_of(pair, a.deviations).solve(0.4, { 150e3 })[0]),
                  te(pair, mesh_of(pair, b.deviations).solve(0.4, { 150e3 })[0]), 0.01);
    }
}

TEST(Topography, RefusesHolesGapsAndWrongUnits)
{
  const std::string key = "topography = { file = \"bad.csv\" }", head = "removed_um(roll_angle_deg,z_mm),-10,0,10\n";
  write_table("bad.csv", head + "14,1,2,3\n20,1,,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "a hole in column 3" })) << refusal(key);
  write_table("bad.csv", head + "14,1,2,3\n20,1,2\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "2 numbers", "3 face positions" })) << refusal(key);
  write_table("bad.csv", head + "16,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "covers roll angles 16.0000 to 28.0000", "14.5371 to 27.1708" })) << refusal(key);
  write_table("bad.csv", "removed_um(roll_angle_deg,z_mm),-8,0,10\n14,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "covers z from -8.0000", "-10.0000 to 10.0000" })) << refusal(key);
  write_table("bad.csv", "deviation,-10,0,10\n14,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:1:", "deviation", "removed_um(diameter_mm,z_mm)" })) << refusal(key);
  write_table("bad.csv", head + "14,1,2,3\n20,1,abc,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "abc", "not a number" })) << refusal(key);
  write_table("bad.csv", head + "28,1,2,3\n14,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "ascend" })) << refusal(key);
  write_table("bad.csv", head + "14,1,2,3\n28,1,22000,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "micrometres" })) << refusal(key);
  EXPECT_TRUE(holds(refusal("topography = { file = \"nowhere.csv\" }"), { "nowhere.csv cannot be read", "topography.file" }));
}

TEST(Input, StartByRollAngleDiameterOrLengthOfRoll)
{
  const auto amount = [](const std::string &start) {
    const ParallelAxisCase input = read("tip_relief = { amount_um = 10, " + start + " }");
    return removed(input.deviations.pinion.modifications, 25 * degree, 0);
  };
  const double rb = 75 * std::cos(20 * degree), roll = 22.2 * degree;
  EXPECT_NEAR(amount("start_roll_angle_deg = 22.2"), 10e-3 * (25 * degree - roll) / (std::sqrt(78 * 78 / rb / rb - 1) - roll), 1e-12);
  EXPECT_NEAR(amount("start_diameter_mm = " + std::to_string(2 * rb * std::hypot(1, roll))), amount("start_roll_angle_deg = 22.2"), 1e-8);
  EXPECT_NEAR(amount("start_length_of_roll_mm = " + std::to_string(rb * roll)), amount("start_roll_angle_deg = 22.2"), 1e-8);
  EXPECT_TRUE(holds(refusal("tip_relief = { amount_um = 10, start_roll_angle_deg = 22.2, start_diameter_mm = 151 }"), { "contradicts" }));
  EXPECT_TRUE(holds(refusal("tip_relief = { amount_um = 10 }"), { "missing", "start_diameter_mm" }));
  EXPECT_TRUE(
      holds(refusal("tip_relief = { amount_um = 10, start_diameter_mm = 156.5 }"), { "start_diameter_mm = 156.5", "to 156.0000 mm" }));
  EXPECT_TRUE(holds(refusal("tip_relief = { start_diameter_mm = 151 }"), { "amount_um: missing" }));
  EXPECT_TRUE(holds(refusal("end_relief = { amount_um = 3 }"), { "end_relief.length_mm", "missing" }));
}

TEST(Input, FlanksListsAndCopies)
{
  // One flank alone replaces both; the other keeps what is given for both.
  const ParallelAxisCase sides = read("lead_crown = { amount_um = 4 }\nright_flank.lead_crown = { amount_um = 9 }");
  EXPECT_NEAR(removed(sides.deviations.pinion.modifications, 0.35, 10), 4e-3, 1e-15); // counter-clockwise: left flanks carry
  EXPECT_NEAR(removed(sides.coast.pinion.modifications, 0.35, 10), 9e-3, 1e-15);
  EXPECT_NEAR(removed(sides.coast.gear.modifications, 0.35, 10), 9e-3, 1e-15);
  const std::string bias =
      "bias = [ { corner = 1, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 }, { corner = 3, amount_um = 2, "
      "start_roll_angle_deg = 20, length_mm = 10 } ]";
  EXPECT_EQ(read(bias).deviations.pinion.modifications.size(), 2u);
  const double tip = read(bias).pair.pinion.tip_roll;
  EXPECT_NEAR(removed(read(bias, { "pinion.bias[1].amount_um=7" }).deviations.pinion.modifications, tip, -10), 7e-3, 1e-12);
  EXPECT_EQ(read(bias, {}, "like = \"pinion\"\nbias = [ { corner = 2, amount_um = 1, start_diameter_mm = 150, length_mm = 3 } ]")
                .deviations.gear.modifications.size(),
            1u); // a list is taken whole
  EXPECT_TRUE(holds(refusal(bias, { "pinion.bias[4].amount_um=7" }), { "there is no pinion.bias[3]" }))
      << refusal(bias, { "pinion.bias[4].amount_um=7" });
  EXPECT_TRUE(holds(refusal("bias = [ { corner = 5, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]"),
                    { "pinion.bias[1].corner = 5", "from 1 to 4" }));
  EXPECT_TRUE(
      holds(refusal("bias = [ { amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]"), { "pinion.bias[1].corner", "missing" }));
  EXPECT_TRUE(holds(refusal("bias = { corner = 1 }"), { "pinion.bias", "list of tables" }));
  EXPECT_TRUE(holds(refusal("index_errors_um = [1, 2, 3]"), { "3 numbers for 50 teeth" }));
  EXPECT_TRUE(holds(refusal("", { "misalignment.in_plane_um=3", "misalignment.in_plane_mrad=1" }), { "contradicts" }));
  EXPECT_TRUE(holds(refusal("", { "pair.axial_offset_mm=25" }), { "pair.axial_offset_mm = 25", "beside each other" }));
  EXPECT_TRUE(holds(refusal("tip_edge = { chamfer_mm = 0.2, rounding_radius_mm = 0.2 }"), { "not both" }));
}

TEST(Misalignment, RigidFlanksInClosedForm)
{
  // Spur: the gap opens by f z/b along the line of action, so the end at -z touches first.
  const double f = 12e-3;
  {
    const GearPair pair = make_gear_pair(paper_pair(0));
    MeshDeviations tilted;
    tilted.misalignment.in_plane = f / 20;
    const double sections        = 4 * small_grid.slices + 1;
    EXPECT_NEAR(mesh_of(pair, tilted).unloaded(0.2).theta * pair.pinion.base_radius, -f / 2 * (1 - 1 / sections), 1e-9);
    const PositionResult loaded = mesh_of(pair, tilted).solve(0.2, { 100e3 })[0];
    EXPECT_LT(loaded.load_centre, -0.5);
    tilted.misalignment.in_plane = -f / 20;
    EXPECT_NEAR(mesh_of(pair, tilted).solve(0.2, { 100e3 })[0].load_centre, -loaded.load_centre, 1e-4); // mm; as above
  }
  // Helical: turned about the pitch point as a rigid body, a flank point also moves along the axis.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  MeshDeviations tilted;
  tilted.misalignment.in_plane = f / 20;
  const double s = std::sin(pair.base_helix_angle), c = std::cos(pair.base_helix_angle);
  for (const double phase : { 0.0, 0.4, 0.8 })
    EXPECT_NEAR(mesh_of(pair, tilted).unloaded(phase).theta * pair.pinion.base_radius,
                rigid_error(pair, phase,
                            [&](double roll, double, double z) {
                              return f / 20 * (z * c + pair.pinion.base_radius * (roll - std::tan(20 * degree)) * s);
                            }),
                2e-4); // sections 0.33 mm apart: f/20 0.33 mm / 2 = 1e-4 mm
  // Across the plane of action nothing changes on it.
  MeshDeviations across;
  across.misalignment.across = f / 20;
  EXPECT_NEAR(mesh_of(pair, across).unloaded(0.4).theta * pair.pinion.base_radius, 0, 1e-6); // mm; beside it, of second order
}

TEST(Mounting, SpringsTurnUntilMomentsBalance)
{
  const GearPair pair      = make_gear_pair(paper_pair(25.232));
  const double   stiffness = 50e6; // N mm/rad
  Mounting       soft;
  soft.tilt_in_plane          = stiffness;
  const PositionResult sprung = mesh_of(pair, {}, soft).solve(0.3, { 150e3 })[0];
  const double         s = std::sin(pair.base_helix_angle), c = std::cos(pair.base_helix_angle);
  double               moment = 0;
  for (const CellResult &cell : sprung.cell_results)
    moment += cell.force * (cell.z * c + pair.pinion.base_radius * cell.pinion_roll * s);
  EXPECT_NEAR(-sprung.tilt[0] * stiffness, moment,
              2e-3 * moment); // the closed form holds on the plane of action; 14 % of the load is at tip edges
  EXPECT_GT(-sprung.tilt[0], 1e-4);
  // The same tilt imposed on rigid mountings: the same contact; only the pivot differs, which adds to the transmission error.
  MeshDeviations tilted;
  tilted.misalignment.in_plane = -sprung.tilt[0];
  const PositionResult imposed = mesh_of(pair, tilted).solve(0.3, { 150e3 })[0];
  const double         pivot   = -sprung.tilt[0] * s * pair.pinion.base_radius * std::tan(20 * degree) / c;
  EXPECT_NEAR(te(pair, sprung), te(pair, imposed) + pivot / micrometre, 2e-3); // windows are sized a little differently
  EXPECT_NEAR(sprung.load_centre, imposed.load_centre, 5e-3);
}

TEST(Mounting, TorsionIsASpringInSeries)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  Mounting       pinion, gear;
  pinion.torsion = 2e8, gear.torsion = 3e8;
  // One pair alone, on the path of action, so that neither gear's lever varies.
  const PositionResult rigid = mesh_of(pair).solve(0.05, { 30e3 })[0], sprung = mesh_of(pair, {}, pinion, gear).solve(0.05, { 30e3 })[0];
  EXPECT_NEAR(sprung.theta - rigid.theta, 30e3 / 2e8 + 30e3 / 3e8, 1e-9 * 30e3 / 2e8);
  EXPECT_NEAR(1 / sprung.stiffness, 1 / rigid.stiffness + 1 / 2e8 + 1 / 3e8, 1e-9 / 2e8);
}

TEST(SingleTeeth, RunoutAndIndexErrorsOfRigidFlanks)
{
  // Unloaded spur pair: an eccentricity e moves the transmission error by e cos(rotation); a tooth that stands back changes nothing
  // while a neighbour carries, and a tooth that stands out carries alone.
  const GearPair pair = make_gear_pair(paper_pair(0));
  MeshDeviations run;
  run.pinion.runout       = 20e-3;
  run.pinion.runout_angle = 0.7;
  for (const int cycle : { 0, 7, 31 })
    for (const double phase : { 0.0, 0.4 })
      EXPECT_NEAR(mesh_of(pair, run).unloaded(phase, cycle).theta * pair.pinion.base_radius,
                  10e-3 * std::cos((cycle + phase) * 2 * units::pi / 50 - 0.7), 1e-9);
  MeshDeviations index;
  index.gear.index_errors.assign(50, 0);
  index.gear.index_errors[3] = -5e-3;
  const LoadedMesh mesh      = mesh_of(pair, index);
  EXPECT_NEAR(mesh.unloaded(0, 3).theta * pair.pinion.base_radius, -5e-3, 1e-9);  // tooth 3 at the pitch point
  EXPECT_NEAR(mesh.unloaded(0, 53).theta * pair.pinion.base_radius, -5e-3, 1e-9); // again after a revolution
  EXPECT_NEAR(mesh.unloaded(0, 8).theta * pair.pinion.base_radius, 0, 1e-9);
  // One grid serves all cycles, and gives what each cycle's own grid gives.
  const auto all = mesh.solve(0.8, { 100e3 }, { 0, 3, 8 });
  EXPECT_NEAR(te(pair, all[1][0]), te(pair, mesh.solve(0.8, { 100e3 }, { 3 })[0][0]), 0.005); // um, as bands at their border
  EXPECT_GT(std::abs(te(pair, all[0][0]) - te(pair, all[1][0])), 0.5);
}

TEST(TipEdge, ChamferAndRoundingEndTheInvolute)
{
  PairData data            = paper_pair(0);
  data.pinion.tip_chamfer  = 0.4;
  const GearPair chamfered = make_gear_pair(data);
  EXPECT_NEAR(chamfered.pinion.usable_tip_radius(), 77.6, 1e-9);
  PairData shorter          = paper_pair(0);
  shorter.pinion.tip_radius = 77.6;
  EXPECT_NEAR(chamfered.transverse_contact_ratio, make_gear_pair(shorter).transverse_contact_ratio, 1e-12);
  // Contact past the end of the involute is that of the shorter tooth: same slices, levers and separations.
  const GearPair       cut = make_gear_pair(shorter);
  const MeshDeviations none;
  const auto           a = MeshPosition(chamfered, none, 0.9).slices(5), b = MeshPosition(cut, none, 0.9).slices(5);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      EXPECT_NEAR(a[i].separation, b[i].separation, 1e-12);
      EXPECT_NEAR(a[i].lever, b[i].lever, 1e-9);
    }
  // The arc is tangent to the involute: no step, no kink, curvature 1/radius; and to the tip circle.
  data.pinion.tip_chamfer  = 0;
  data.pinion.tip_rounding = 0.3;
  const GearPair round     = make_gear_pair(data);
  const double   rb = round.pinion.base_radius, u = round.pinion.usable_tip_roll;
  EXPECT_NEAR(std::pow(78 - 0.3, 2), rb * rb + std::pow(rb * u - 0.3, 2), 1e-9);
  const MeshPosition sharp_position(cut, none, 0.9), round_position(round, none, 0.9);
  const auto         gap = [&](const double along) {
    const double roll = std::sqrt(u * u + 2 * along / rb);
    return round_position.facing(1, roll, 0).separation -
           MeshPosition(make_gear_pair(paper_pair(0)), none, 0.9).facing(1, roll, 0).separation;
  };
  EXPECT_NEAR(gap(-0.01), 0, 1e-12);
  EXPECT_NEAR(gap(0.05), 0.3 - std::sqrt(0.09 - 0.0025), 1e-9);
  // Under load the rounded tooth lies between the full one and one that ends where the rounding starts.
  PairData ends           = paper_pair(0);
  ends.pinion.tip_chamfer = 78 - round.pinion.usable_tip_radius();
  const GearPair full = make_gear_pair(paper_pair(0)), end = make_gear_pair(ends);
  const double   low = te(full, mesh_of(full).solve(0.93, { 200e3 })[0]), high = te(end, mesh_of(end).solve(0.93, { 200e3 })[0]),
               between = te(round, mesh_of(round).solve(0.93, { 200e3 })[0]);
  EXPECT_LT(low, high);
  EXPECT_GT(between, low);
  EXPECT_LT(between, high);
}

TEST(TipEdge, UnmodifiedSpurPairGrowsSmoothlyAndHasNoJumps)
{
  const GearPair   pair   = make_gear_pair(paper_pair(0));
  const LoadedMesh mesh   = mesh_of(pair, {}, {}, {}, 5);
  double           before = 0, step_before = 0;
  for (const double torque : { 75e3, 150e3, 225e3, 300e3, 375e3, 450e3 })
    {
      const double now = first_harmonic(mesh, torque, 32);
      EXPECT_GT(now, before) << torque;
      if (step_before > 0)
        {
          EXPECT_LT(now - before, 1.2 * step_before) << torque; // it saturates; without tip contact it would go on in proportion
        }
      step_before = now - before;
      before      = now;
    }
  // Where the incoming pair touches at its tip edge: steps shrink with the positions, as they would not at a jump.
  const auto greatest_step = [&](const double step) {
    double greatest = 0, last = te(pair, mesh.solve(0.86, { 300e3 })[0]);
    for (double phase = 0.86 + step; phase < 0.95; phase += step)
      {
        const double now = te(pair, mesh.solve(phase, { 300e3 })[0]);
        greatest         = std::max(greatest, std::abs(now - last));
        last             = now;
      }
    return greatest;
  };
  const double coarse = greatest_step(0.01), fine = greatest_step(0.001);
  EXPECT_LT(fine, 0.15 * coarse); // ten times the positions: a tenth, where the transmission error is continuous
}

TEST(Extreme, LargeReliefAndAllLoadOnOneCornerStayCertified)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  MeshDeviations deviations;
  const double   tip              = pair.pinion.tip_roll;
  deviations.pinion.modifications = { std::make_shared<ProfileRelief>("tip relief", 0.3, 18 * degree, tip, ReliefShape::linear),
                                      std::make_shared<LeadCrown>(0.1, 20) };
  deviations.gear.modifications   = deviations.pinion.modifications;
  for (const double phase : { 0.0, 0.4 })
    EXPECT_TRUE(mesh_of(pair, deviations).solve(phase, { 5e3, 300e3 })[0].certificate.holds());
  // Everything but one corner stands back.
  MeshDeviations corner;
  corner.misalignment.in_plane = 0.4 / 20;
  corner.pinion.modifications  = { std::make_shared<ProfileSlope>(-0.2, pair.pinion_roll.start_of_active_profile, tip) };
  for (const double phase : { 0.0, 0.35, 0.7 })
    {
      const PositionResult result = mesh_of(pair, corner).solve(phase, { 50e3 })[0];
      EXPECT_TRUE(result.certificate.holds());
      EXPECT_LT(result.load_centre, -7);
    }
}

TEST(LoadDistribution, FaceLoadFactorAndMoments)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  PositionResult even, slanted;
  for (int s = 0; s < 5; ++s)
    {
      even.lines.push_back({ 0, -8 + 4.0 * s, 0.36, 100, 500, 0.1 });
      slanted.lines.push_back({ 0, -8 + 4.0 * s, 0.36, 100.0 * s, 500, 0.1 });
    }
  EXPECT_NEAR(face_load_factor(pair, { even }, 5), 1, 1e-12);
  EXPECT_NEAR(face_load_factor(pair, { slanted }, 5), 2, 1e-12);
  // A crowned pair under load: line loads and cells sum to the torque, by symmetry nothing shuttles on a spur pair.
  const PositionResult result = mesh_of(pair, on_pinion(std::make_shared<LeadCrown>(10e-3, 20))).solve(0, { 100e3 })[0];
  double               total  = 0;
  for (const LineLoad &line : result.lines)
    total += line.load_per_length * 20.0 / small_grid.slices;
  EXPECT_NEAR(total * pair.pinion.base_radius, 100e3, 1); // all on the path of action at phase 0
  EXPECT_NEAR(result.load_centre, 0, 1e-5);               // mm; the two ends' near fields are tabulated apart
  EXPECT_GT(face_load_factor(pair, { result }, small_grid.slices), 1.2);
}
