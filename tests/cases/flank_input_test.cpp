// SPDX-License-Identifier: GPL-2.0-or-later
// Flanks in the case file: tables, starts, lists, copies; what is refused and how.
#include "tests/contact/deviations.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace flank;
using units::degree;

TEST(Topography, RefusesHolesGapsAndWrongUnits)
{
  const std::string key = "topography = { file = \"bad.csv\" }",
                    head = "removed_um(roll_angle_deg,z_mm),-10,0,10\n";
  write_table("bad.csv", head + "14,1,2,3\n20,1,,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "a hole in column 3" })) << refusal(key);
  write_table("bad.csv", head + "14,1,2,3\n20,1,2\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "2 numbers", "3 face positions" })) << refusal(key);
  write_table("bad.csv", head + "16,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "covers roll angles 16.0000 to 28.0000", "14.5371 to 27.1708" }))
      << refusal(key);
  for (const std::string cell : { "1 2 3", "\"1\"2", "1\t2", "\"1", "\" \"", "1\"" })
    {
      write_table("bad.csv", head + "14,1," + cell + ",3\n28,1,2,3\n");
      EXPECT_TRUE(holds(refusal(key), { "bad.csv:2:", "column 3" })) << cell;
    }
  write_table("bad.csv", "removed_um(roll_angle_deg,z_mm),-8,0,10\n14,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "covers z from -8.0000", "-10.0000 to 10.0000" })) << refusal(key);
  write_table("bad.csv", "removed_um(roll_angle_deg,z_mm),-10,0,8\n14,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "to 8.0000", "-10.0000 to 10.0000" })) << refusal(key);
  write_table("bad.csv", "deviation,-10,0,10\n14,1,2,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:1:", "deviation", "removed_um(diameter_mm,z_mm)" }))
      << refusal(key);
  write_table("bad.csv", head + "14,1,2,3\n20,1,abc,3\n28,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "abc", "not a number" })) << refusal(key);
  write_table("bad.csv", head + "28,1,2,3\n14,1,2,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "ascend" })) << refusal(key);
  write_table("bad.csv", head + "14,1,2,3\n28,1,22000,3\n");
  EXPECT_TRUE(holds(refusal(key), { "bad.csv:3:", "micrometres" })) << refusal(key);
  EXPECT_TRUE(holds(refusal("topography = { file = \"nowhere.csv\" }"),
                    { "nowhere.csv cannot be read", "topography.file" }));
}

TEST(Input, StartByRollAngleDiameterOrLengthOfRoll)
{
  const auto amount = [](const std::string &start) {
    const ParallelAxisCase input = read("tip_relief = { amount_um = 10, " + start + " }");
    return removed(input.deviations.pinion.modifications, 25 * degree, 0);
  };
  const double rb = 75 * std::cos(20 * degree), roll = 22.2 * degree;
  EXPECT_NEAR(amount("start_roll_angle_deg = 22.2"),
              10e-3 * (25 * degree - roll) / (std::sqrt(78 * 78 / rb / rb - 1) - roll), 1e-12);
  EXPECT_NEAR(amount("start_diameter_mm = " + std::to_string(2 * rb * std::hypot(1, roll))),
              amount("start_roll_angle_deg = 22.2"), 1e-8);
  EXPECT_NEAR(amount("start_length_of_roll_mm = " + std::to_string(rb * roll)),
              amount("start_roll_angle_deg = 22.2"), 1e-8);
  EXPECT_TRUE(
      holds(refusal("tip_relief = { amount_um = 10, start_roll_angle_deg = 22.2, start_diameter_mm = 151 }"),
            { "contradicts" }));
  EXPECT_TRUE(holds(refusal("tip_relief = { amount_um = 10 }"), { "missing", "start_diameter_mm" }));
  EXPECT_TRUE(holds(refusal("tip_relief = { amount_um = 10, start_diameter_mm = 156.5 }"),
                    { "start_diameter_mm = 156.5", "to 156.0000 mm" }));
  EXPECT_TRUE(holds(refusal("tip_relief = { start_diameter_mm = 151 }"), { "amount_um: missing" }));
  EXPECT_TRUE(holds(refusal("end_relief = { amount_um = 3 }"), { "end_relief.length_mm", "missing" }));
}

TEST(Topography, OfAGearByItsOwnDiametersAndMirroredWhereItIsCopied)
{
  std::string table = "removed_um(diameter_mm,z_mm),-10,0,10\n";
  for (const int d : { 158, 165, 174 })
    table += std::to_string(d) + "," + std::to_string(d - 155) + "," + std::to_string(d - 154) + "," +
             std::to_string(d - 150) + "\n";
  write_table("gear.csv", table);
  const ParallelAxisCase unequal = read("", { "pair.centre_distance_mm=159" },
                                        "like = \"pinion\"\nteeth = 56\ntip_diameter_mm = "
                                        "174\nroot_diameter_mm = 158.68\nbore_diameter_mm = 80\n"
                                        "topography = { file = \"gear.csv\" }");
  const double rb = 84 * std::cos(20 * degree),
               roll = std::sqrt(std::pow(82.5 / rb, 2) - 1); // at the diameter of 165 mm
  EXPECT_NEAR(removed(unequal.deviations.gear.modifications, roll, -10), 10e-3, 1e-9);
  EXPECT_NEAR(removed(unequal.deviations.gear.modifications, roll, 10), 15e-3, 1e-9);
  // The flank of a gear that is like the pinion is its mirror image: the other hand.
  write_table("both.csv", "removed_um(roll_angle_deg,z_mm),-10,0,10\n14,1,2,4\n20,2,3,7\n28,5,6,9\n");
  const ParallelAxisCase both = read("topography = { file = \"both.csv\" }");
  for (const double z : { -10.0, 3.0, 10.0 })
    EXPECT_NEAR(removed(both.deviations.gear.modifications, 20 * degree, z),
                removed(both.deviations.pinion.modifications, 20 * degree, -z), 1e-12);
  EXPECT_NEAR(removed(both.deviations.pinion.modifications, 20 * degree, 10), 7e-3, 1e-9);
}

TEST(Input, OneBodyForBothGearsWhereNothingOfThemDiffers)
{
  EXPECT_EQ(read("").bodies().size(), 1u);
  EXPECT_EQ(read("", { "gear.lead_crown.amount_um=9" }).bodies().size(), 1u); // gaps are no bodies
  for (const std::string other : { "teeth=51", "face_width_mm=19", "tip_diameter_mm=155.9",
                                   "root_diameter_mm=140.5", "tooth_thickness_mm=4.6", "bore_diameter_mm=70",
                                   "fillet_radius_mm=0.9", "youngs_modulus_GPa=200", "poissons_ratio=0.29" })
    {
      std::vector<std::string> settings{ "gear." + other };
      if (other == "teeth=51")
        settings.insert(settings.end(), { "pair.centre_distance_mm=151.5", "gear.tip_diameter_mm=159",
                                          "gear.root_diameter_mm=143.68" });
      EXPECT_EQ(read("", settings).bodies().size(), 2u) << other;
    }
}

// Element layers follow the face up to 20 modules of 3 mm, then wait until they are 2.6 modules long,
// of spur gears 4.16.
TEST(Input, WideFacesHaveLongerElements)
{
  for (const auto &[face_width, layers] :
       { std::pair{ 20, 10 }, { 60, 30 }, { 120, 30 }, { 240, 31 }, { 500, 64 } })
    {
      const ParallelAxisCase input = read("", { fmt::format("pinion.face_width_mm={}", face_width) });
      EXPECT_EQ(input.pinion_mesh.face_layers, layers) << face_width;
      EXPECT_EQ(input.gear_mesh.face_layers, layers) << face_width;
      const ParallelAxisCase spur =
          read("", { fmt::format("pinion.face_width_mm={}", face_width), "pair.helix_angle_deg=0" });
      EXPECT_EQ(spur.pinion_mesh.face_layers, face_width == 500 ? 40 : std::min(layers, 30)) << face_width;
    }
}

TEST(Input, FlanksListsAndCopies)
{
  // One flank alone replaces both; the other keeps what is given for both.
  const ParallelAxisCase sides =
      read("lead_crown = { amount_um = 4 }\nright_flank.lead_crown = { amount_um = 9 }");
  EXPECT_NEAR(removed(sides.deviations.pinion.modifications, 0.35, 10), 4e-3,
              1e-15); // counter-clockwise: left flanks carry
  EXPECT_NEAR(removed(sides.coast.pinion.modifications, 0.35, 10), 9e-3, 1e-15);
  EXPECT_NEAR(removed(sides.coast.gear.modifications, 0.35, 10), 9e-3, 1e-15);
  const std::string bias = "bias = [ { corner = 1, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 "
                           "}, { corner = 3, amount_um = 2, "
                           "start_roll_angle_deg = 20, length_mm = 10 } ]";
  EXPECT_EQ(read(bias).deviations.pinion.modifications.size(), 2u);
  const double tip = read(bias).pair.pinion.tip_roll;
  EXPECT_NEAR(removed(read(bias, { "pinion.bias[1].amount_um=7" }).deviations.pinion.modifications, tip, -10),
              7e-3, 1e-12);
  EXPECT_EQ(read(bias, {},
                 "like = \"pinion\"\nbias = [ { corner = 2, amount_um = 1, start_diameter_mm = 150, "
                 "length_mm = 3 } ]")
                .deviations.gear.modifications.size(),
            1u); // a list is taken whole
  EXPECT_TRUE(holds(refusal(bias, { "pinion.bias[4].amount_um=7" }), { "there is no pinion.bias[3]" }))
      << refusal(bias, { "pinion.bias[4].amount_um=7" });
  EXPECT_TRUE(
      holds(refusal("bias = [ { corner = 5, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]"),
            { "pinion.bias[1].corner = 5", "from 1 to 4" }));
  EXPECT_TRUE(holds(refusal("bias = [ { amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]"),
                    { "pinion.bias[1].corner", "missing" }));
  EXPECT_TRUE(holds(refusal("bias = { corner = 1 }"), { "pinion.bias", "list of tables" }));
  EXPECT_TRUE(holds(refusal("index_errors_um = [1, 2, 3]"), { "3 numbers for 50 teeth" }));
  EXPECT_TRUE(holds(refusal("", { "misalignment.in_plane_um=3", "misalignment.in_plane_mrad=1" }),
                    { "contradicts" }));
  EXPECT_TRUE(holds(refusal("", { "pair.axial_offset_mm=25" }),
                    { "pair.axial_offset_mm = 25", "beside each other" }));
  EXPECT_TRUE(holds(refusal("tip_edge = { chamfer_mm = 0.2, rounding_radius_mm = 0.2 }"), { "not both" }));
}
