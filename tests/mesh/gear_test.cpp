// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/microgeometry.hpp"
#include "mesh/gear/tooth_profile.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

using namespace flank;
using units::degree;

// Gears without profile shift at the distance of their reference circles: no backlash, whatever rounding
// makes of it; a hair closer they jam.
TEST(Pair, NominalGearsHaveNoBacklashAndDoNotJam)
{
  for (const int teeth : { 43, 50, 61, 77 })
    for (const double module : { 0.7, 3.0, 7.1 })
      for (const double angle : { 20.0, 22.5, 25.0 })
        {
          PairData data = paper_pair(angle / 2);
          data.transverse_module = module;
          data.transverse_pressure_angle = angle * degree;
          data.pinion.teeth = teeth;
          for (GearData *gear : { &data.pinion, &data.gear })
            {
              const double radius = module * gear->teeth / 2;
              gear->tip_radius = radius + module;
              gear->root_radius = radius - 1.25 * module;
              gear->bore_radius = 0.5 * radius;
              gear->fillet_radius = 0.25 * module;
              gear->tooth_thickness = std::numeric_limits<double>::quiet_NaN();
              gear->profile_shift = 0;
            }
          data.centre_distance = module * (teeth + 50) / 2.0;
          EXPECT_EQ(make_gear_pair(data).backlash, 0) << teeth << " " << module << " " << angle;
          data.centre_distance *= 1 - 1e-10;
          EXPECT_THROW(make_gear_pair(data), InputError) << teeth << " " << module << " " << angle;
        }
}

TEST(Helicoid, NormalIsPerpendicularToTheSurface)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const InvoluteHelicoid flank = pair.pinion.flank();
  const double h = 1e-6;
  for (const double roll : { 0.2, 0.36, 0.47 })
    for (const double z : { -7.0, 3.0 })
      {
        const FlankFrame f = flank.frame(roll, z);
        const Eigen::Vector3d along_roll =
            (flank.frame(roll + h, z).origin - flank.frame(roll - h, z).origin) / (2 * h);
        const Eigen::Vector3d along_z =
            (flank.frame(roll, z + h).origin - flank.frame(roll, z - h).origin) / (2 * h);
        // Central differences of step 1e-6 on lengths of 75 mm: 1e-8.
        EXPECT_NEAR(f.inward.dot(along_roll), 0, 1e-7);
        EXPECT_NEAR(f.inward.dot(along_z), 0, 1e-7);
        EXPECT_NEAR((f.profile.cross(f.generator) - f.inward).norm(), 0, 1e-14);
        // The generator stays in the surface: a step along it lands on the flank.
        const double step = 0.7;
        const Eigen::Vector3d there =
            flank.frame(roll + step * flank.roll_per_generator(), z + step * flank.cos_base_helix()).origin;
        EXPECT_NEAR((there - f.origin - step * f.generator).norm(), 0, 1e-12);
        EXPECT_NEAR(f.origin.head<2>().norm(), radius_at_roll(roll, pair.pinion.base_radius), 1e-12);
      }
}

TEST(GearPair, DerivedGeometryOfThePaperPair) // design figures, given to the digits shown
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  EXPECT_NEAR(pair.pinion.base_radius, 70.47695, 1e-5);
  EXPECT_NEAR(pair.transverse_contact_ratio, 1.75467, 1e-5);
  EXPECT_NEAR(pair.overlap_ratio, 1.0000, 1e-4);
  EXPECT_NEAR(pair.base_helix_angle / degree, 23.885, 1e-3);
  EXPECT_NEAR(pair.pinion_roll.start_of_active_profile / degree, 14.537, 1e-3);
  EXPECT_NEAR(pair.pinion_roll.lowest_single_contact / degree, 19.971, 1e-3);
  EXPECT_NEAR(pair.pinion_roll.pitch_point / degree, 20.854, 1e-3);
  EXPECT_NEAR(pair.pinion_roll.highest_single_contact / degree, 21.737, 1e-3);
  EXPECT_NEAR(pair.pinion_roll.tip / degree, 27.171, 1e-3);
  EXPECT_NEAR(pair.backlash, 0.145, 5e-4);
  // From closed forms, to rounding.
  EXPECT_NEAR(pair.pinion.base_radius, 75 * std::cos(20 * degree), 1e-6);
  EXPECT_NEAR(pair.backlash, 3 * units::pi - 2 * 4.64, 1e-6);
  EXPECT_NEAR(pair.overlap_ratio, 20 * std::tan(25.232 * degree) / (3 * units::pi), 1e-6);
  EXPECT_NEAR(pair.base_helix_angle, std::atan(std::tan(25.232 * degree) * std::cos(20 * degree)), 1e-6);
  const double base = 75 * std::cos(20 * degree), tip = std::tan(std::acos(base / 78)),
               line = 2 * 75 * std::sin(20 * degree), pitch = 2 * units::pi / 50;
  EXPECT_NEAR(pair.length_of_action, 2 * base * tip - line, 1e-6);
  EXPECT_NEAR(pair.transverse_contact_ratio, (2 * base * tip - line) / (base * pitch), 1e-6);
  for (const RollAngles *roll : { &pair.pinion_roll, &pair.gear_roll })
    {
      EXPECT_NEAR(roll->tip / degree, tip / degree, 1e-6);
      EXPECT_NEAR(roll->start_of_active_profile / degree, (line / base - tip) / degree, 1e-6);
      EXPECT_NEAR(roll->pitch_point / degree, std::tan(20 * degree) / degree, 1e-6);
      EXPECT_NEAR(roll->lowest_single_contact / degree, (tip - pitch) / degree, 1e-6);
      EXPECT_NEAR(roll->highest_single_contact / degree, (line / base - tip + pitch) / degree, 1e-6);
    }
}

TEST(GearPair, DerivedGeometryOfAnUnequalPair) // ISO 21771, written out
{
  PairData data = unequal_pair();
  data.centre_distance = 159.1;
  data.pinion.tip_radius = 78.1;
  data.gear.face_width = 16;
  data.axial_offset = 4;
  const GearPair pair = make_gear_pair(data);
  EXPECT_NEAR(pair.pinion_tip_clearance, 159.1 - 78.1 - 79.3, 1e-9);
  EXPECT_NEAR(pair.gear_tip_clearance, 159.1 - 87 - 70.34, 1e-9);
  EXPECT_NEAR(pair.face_low, -4, 1e-9);
  EXPECT_NEAR(pair.face_high, 10, 1e-9);
  EXPECT_NEAR(pair.overlap_ratio, 14 * std::tan(15 * degree) / (3 * units::pi),
              1e-9); // of the common face width
  const double base = std::cos(20 * degree), working = std::acos((75 + 84) * base / 159.1),
               line = 159.1 * std::sin(working);
  EXPECT_NEAR(pair.working_pressure_angle, working, 1e-9);
  const double tips =
      std::sqrt(78.1 * 78.1 - std::pow(75 * base, 2)) + std::sqrt(87 * 87 - std::pow(84 * base, 2));
  EXPECT_NEAR(pair.length_of_action, tips - line, 1e-9);
  EXPECT_NEAR(pair.transverse_contact_ratio, (tips - line) / (3 * units::pi * base), 1e-9);
  EXPECT_NEAR(pair.pinion_roll.start_of_active_profile,
              (line - std::sqrt(87 * 87 - std::pow(84 * base, 2))) / (75 * base), 1e-9);
  EXPECT_NEAR(pair.gear_roll.start_of_active_profile,
              (line - std::sqrt(78.1 * 78.1 - std::pow(75 * base, 2))) / (84 * base), 1e-9);
  EXPECT_NEAR(pair.pinion_roll.pitch_point, std::tan(working), 1e-9);
  // Backlash at the working pitch circles: the pitch there less both thicknesses, each by the involute
  // function.
  const auto involute = [](const double angle) { return std::tan(angle) - angle; };
  double backlash = 2 * units::pi * 159.1 / (50 + 56);
  for (const double radius : { 75.0, 84.0 })
    backlash -= 2 * radius * 159.1 / 159 * (4.64 / (2 * radius) + involute(20 * degree) - involute(working));
  EXPECT_NEAR(pair.backlash, backlash, 1e-9);
}

TEST(GearPair, RefusesWhatCannotMesh)
{
  const auto quantity_of = [](const PairData &data) {
    try
      {
        make_gear_pair(data);
      }
    catch (const InputError &error)
      {
        return error.quantity;
      }
    return std::string("accepted");
  };
  PairData data = paper_pair(0);
  EXPECT_EQ(quantity_of(data), "accepted");
  data.pinion.tip_radius = 82; // reaches the other's root
  EXPECT_EQ(quantity_of(data), "pinion tip diameter");
  data = paper_pair(0);
  data.gear.bore_radius = 70;
  EXPECT_EQ(quantity_of(data), "gear bore diameter");
  data = paper_pair(0);
  data.gear.fillet_radius = 2.5;
  EXPECT_EQ(quantity_of(data), "gear fillet radius");
  data = paper_pair(0);
  data.centre_distance = 149; // the teeth jam
  EXPECT_EQ(quantity_of(data), "centre distance");
  data = paper_pair(0);
  data.pinion.tooth_thickness = 9.6;
  EXPECT_EQ(quantity_of(data), "pinion tooth thickness");
  data = paper_pair(0);
  data.gear.tip_radius = 81.5; // flanks meet below the tip: pointed
  data.pinion.root_radius = 66, data.pinion.fillet_radius = 0.3;
  EXPECT_EQ(quantity_of(data), "gear tip diameter");
  data = twelve_tooth_pair(0);
  data.gear.teeth = 100, data.gear.tip_radius = 153, data.gear.root_radius = 146.4,
  data.gear.bore_radius = 60;
  data.pinion.profile_shift = 0, data.gear.profile_shift = 0,
  data.centre_distance = 168; // its tips reach below the pinion's base circle
  EXPECT_EQ(quantity_of(data), "gear tip diameter");
}

TEST(GearPair, WarnsOfUndercutThinRimAndSmallClearance)
{
  const auto warned = [](const PairData &data, const std::string &word) {
    const auto warnings = make_gear_pair(data).warnings;
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string &w) { return w.find(word) != std::string::npos; });
  };
  EXPECT_FALSE(warned(paper_pair(0), "undercut"));
  PairData data = twelve_tooth_pair(0);
  EXPECT_TRUE(warned(data, "undercut")) << "12 teeth with x = 0.2";
  data = paper_pair(0);
  data.pinion.bore_radius = 66;
  EXPECT_TRUE(warned(data, "thin rim"));
  data = paper_pair(0);
  data.gear.root_radius = 71.8, data.gear.fillet_radius = 0.5;
  EXPECT_TRUE(warned(data, "tip clearance"));
}

TEST(ToothProfile, FilletIsTangentToInvoluteAndRootCircle)
{
  for (const bool deep_root : { false, true })
    {
      PairData data = paper_pair(0);
      Gear gear = make_gear_pair(data).pinion;
      if (deep_root)
        gear.root_radius = 68.5; // the fillet cannot reach the involute: radial line
      const ToothProfile profile(gear);
      const double h = 1e-6;
      const Eigen::Vector2d top = profile.fillet_point(0),
                            tangent = (profile.fillet_point(h) - top).normalized(),
                            bottom = profile.fillet_point(1);
      const Eigen::Vector2d above =
          profile.fillet_top_radius() < profile.form_radius() - 1e-9
              ? Eigen::Vector2d(profile.radial_line_point(profile.fillet_top_radius() + h) - top)
              : Eigen::Vector2d(
                    profile.involute_point(roll_angle(profile.form_radius() + h, gear.base_radius)) - top);
      EXPECT_EQ(profile.fillet_top_radius() < profile.form_radius() - 1e-9, deep_root);
      EXPECT_NEAR(above.normalized().dot(tangent), -1, 1e-9);
      EXPECT_NEAR(bottom.norm(), gear.root_radius, 1e-12);
      const Eigen::Vector2d end = (bottom - profile.fillet_point(1 - h)).normalized();
      EXPECT_NEAR(end.dot(bottom.normalized()), 0, 1e-5);
    }
}

TEST(Microgeometry, FormulasAtPoints)
{
  const ProfileRelief linear("tip relief", 0.01, 0.3, 0.5, ReliefShape::linear, 70),
      quadratic("tip relief", 0.01, 0.3, 0.5, ReliefShape::quadratic, 70);
  const ProfileRelief root("root relief", 0.01, 0.3, 0.2, ReliefShape::linear, 70);
  EXPECT_DOUBLE_EQ(linear.removed(0.25, 0), 0);
  EXPECT_DOUBLE_EQ(linear.removed(0.4, 3), 0.005);
  EXPECT_DOUBLE_EQ(quadratic.removed(0.4, 3), 0.0025);
  EXPECT_DOUBLE_EQ(root.removed(0.25, 0), 0.005);
  EXPECT_DOUBLE_EQ(root.removed(0.31, 0), 0);
  EXPECT_DOUBLE_EQ(LeadCrown(0.004, 20).removed(0.3, -5), 0.001);
}
