// SPDX-License-Identifier: GPL-2.0-or-later
// Modifications: formulas at points, rigid flanks against a sampling that shares no code, corners, mirrors,
// tables.
#include "contact/loaded/load_distribution.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

using namespace flank;
using units::degree;
using units::micrometre;

namespace
{
  MeshDeviations on_gear(std::shared_ptr<const FlankModification> modification)
  {
    MeshDeviations deviations;
    deviations.gear.modifications = { std::move(modification) };
    return deviations;
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
  const ProfileRelief tip("tip relief", 10e-3, 0.35, 0.45, ReliefShape::quadratic, 70),
      root("root relief", 10e-3, 0.30, 0.25, ReliefShape::linear, 70);
  EXPECT_NEAR(tip.removed(0.40, 0), 2.5e-3, 1e-15);
  EXPECT_NEAR(root.removed(0.26, 0), 8e-3, 1e-15);
  EXPECT_EQ(root.removed(0.31, 0), 0);
}

TEST(Modification, BiasCornersByTheirFormula)
{
  // Corner at the tip and -z, 5 um, from roll 0.3 at the face end to 10 mm along the tip (roll 0.5); b = 20
  // mm.
  for (const auto &[shape, power] : { std::pair{ ReliefShape::linear, 1 }, { ReliefShape::quadratic, 2 } })
    {
      const CornerBias bias(1, 5e-3, 0.3, 0.5, 10, 20, -1, shape, 70);
      EXPECT_NEAR(bias.removed(0.5, -10), 5e-3, 1e-15);
      EXPECT_NEAR(bias.removed(0.3, -10), 0, 1e-15);
      EXPECT_NEAR(bias.removed(0.5, 0), 0, 1e-15);
      EXPECT_NEAR(bias.removed(0.4, -5), 0, 1e-15); // on the line u = v
      EXPECT_NEAR(bias.removed(0.45, -8), 5e-3 * std::pow(0.75 - 0.2, power), 1e-15);
      EXPECT_EQ(bias.removed(0.5, 10), 0);
    }
  const CornerBias root(3, 5e-3, 0.35, 0.25, 10, 20, 1, ReliefShape::linear, 70);
  EXPECT_NEAR(root.removed(0.25, 10), 5e-3, 1e-15);
  EXPECT_NEAR(root.removed(0.25, 0), 0, 1e-15);
  EXPECT_NEAR(root.removed(0.30, 9), 5e-3 * (0.5 - 0.1), 1e-15);
}

namespace
{
  using Parameter = FlankModification::Parameter;

  /// Second derivative of what is removed along a length of the flank, by differences over 2 `step`. [1/mm]
  template <class Removed>
  double curvature(const Removed &removed, const double at, const double step)
  {
    return (removed(at + step) - 2 * removed(at) + removed(at - step)) / (step * step);
  }
} // namespace

/// The line where a relief starts, which its kink lies on: the roll angle, the distance from an end, the
/// diagonal of a corner; the crest of ends that meet; nowhere of a crown.
TEST(Modification, StartsOnItsLine)
{
  const ReliefForm linear{ ReliefShape::linear, 0 };
  const ProfileRelief tip("tip relief", 10e-3, 0.35, 0.45, linear, 70),
      root("root relief", 10e-3, 0.3, 0.2, linear, 70);
  EXPECT_TRUE(tip.starts_within(0.34, 0.36, -1, 1));
  EXPECT_FALSE(tip.starts_within(0.36, 0.44, -1, 1));
  EXPECT_FALSE(tip.starts_within(0.30, 0.34, -1, 1));
  EXPECT_TRUE(root.starts_within(0.29, 0.31, -1, 1));
  EXPECT_FALSE(root.starts_within(0.22, 0.28, -1, 1));
  const EndRelief end(12e-3, 4, 20, 1, linear), both(12e-3, 4, 20, 0, linear),
      meeting(12e-3, 12, 20, 0, linear);
  EXPECT_TRUE(end.starts_within(0.3, 0.4, 5.5, 6.5));
  EXPECT_FALSE(end.starts_within(0.3, 0.4, -6.5, -5.5));
  EXPECT_TRUE(both.starts_within(0.3, 0.4, -6.5, -5.5));
  EXPECT_FALSE(both.starts_within(0.3, 0.4, -1, 1));
  EXPECT_TRUE(meeting.starts_within(0.3, 0.4, -1, 1));
  EXPECT_FALSE(meeting.starts_within(0.3, 0.4, 1, 2));
  const CornerBias corner(1, 20e-3, 0.35, 0.45, 4, 20, -1, linear, 70); // from (0.35, -10) to (0.45, -6)
  EXPECT_TRUE(corner.starts_within(0.39, 0.41, -8.1, -7.9));
  EXPECT_FALSE(corner.starts_within(0.39, 0.41, -7.0, -6.6));
  EXPECT_FALSE(corner.starts_within(0.39, 0.41, -9.9, -8.8));
  EXPECT_FALSE(LeadCrown(5e-3, 20).starts_within(0.2, 0.5, -10, 10));
}

/// Rounded by 40 mm, a linear relief has that radius along the flank where it starts, the straight relief's
/// amount at its end, and no kink; without a radius it is the linear one.
TEST(Modification, BlendedStartsAreArcsOfTheirRadius)
{
  const double rb = 70, radius = 40;
  const ReliefForm blended{ ReliefShape::linear, radius }, none{ ReliefShape::linear, 0 };
  const ProfileRelief tip("tip relief", 10e-3, 0.35, 0.45, blended, rb),
      sharp("tip relief", 10e-3, 0.35, 0.45, none, rb);
  const EndRelief end(12e-3, 4, 20, 1, blended);
  const CornerBias bias(1, 20e-3, 0.35, 0.45, 3, 20, -1, blended, rb);
  const auto infinite = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(tip.turn().along_profile, radius * 10e-3 / (rb * 0.35 * 0.1), 1e-12); // radius times slope
  EXPECT_NEAR(end.turn().along_face, radius * 12e-3 / 4, 1e-12);
  EXPECT_EQ(tip.turn().along_face, infinite);
  EXPECT_EQ(end.turn().along_profile, infinite);
  EXPECT_GT(std::min(bias.turn().along_profile, bias.turn().along_face), 0);
  EXPECT_EQ(sharp.turn().along_profile, 0);
  EXPECT_EQ(EndRelief(12e-3, 12, 20, 0, ReliefShape::quadratic).turn().along_face, 0) << "the ends meet";
  EXPECT_EQ(EndRelief(12e-3, 12, 20, 1, ReliefShape::quadratic).turn().along_face, infinite);
  const auto of_tip = [&](const double x) {
    return tip.removed(std::sqrt(0.35 * 0.35 + 2 * x / rb), 0); // x: along the involute from the start
  };
  // A relief that is linear in the roll angle is slightly curved along the flank, as far as its slope has
  // come.
  const double of_roll = -1 / (rb * rb * std::pow(0.35, 3) * 0.1);
  EXPECT_NEAR(curvature(of_tip, 0, 0.01), 1 / radius + 10e-3 / 2 * of_roll, 1e-7);
  const auto of_end = [&](const double z) { return end.removed(0.4, 6 + z); };
  EXPECT_NEAR(curvature(of_end, 0, 0.01), 1 / radius, 1e-9);
  const double along_profile = 1 / (rb * 0.35 * 0.1), along_z = 1 / 3.0,
               all = std::hypot(along_profile, along_z);
  const auto of_bias = [&](const double x) { // up the corner's steepest line, from (start, face end)
    return bias.removed(std::sqrt(0.35 * 0.35 + 2 * x * along_profile / all / rb), -10 - x * along_z / all);
  };
  EXPECT_NEAR(curvature(of_bias, 0, 0.005),
              1 / radius + 20e-3 / 2 * of_roll * std::pow(along_profile / all, 2), 1e-7);
  // Half of the blend is amount x radius x gradient^2 / 2 of the relief's length, and ends on the straight
  // line.
  const double h = radius * 10e-3 * along_profile * along_profile / 2;
  EXPECT_NEAR(tip.removed(0.35, 0), 10e-3 * h / 4, 1e-15);
  for (const double s : { -1.2 * h, -h, h, 0.5, 1.0 })
    EXPECT_NEAR(tip.removed(0.35 + 0.1 * s, 0), sharp.removed(0.35 + 0.1 * s, 0), 1e-15);
}

TEST(Modification, DerivativesOfBlendedStarts)
{
  const ReliefForm blended{ ReliefShape::linear, 40 };
  const ProfileRelief tip("tip relief", 10e-3, 0.35, 0.45, blended, 70),
      root("root relief", 10e-3, 0.30, 0.22, blended, 70);
  const EndRelief end(12e-3, 4, 20, 1, blended);
  const CornerBias bias(1, 20e-3, 0.35, 0.45, 3, 20, -1, blended, 70);
  struct Case
  {
    const FlankModification &of;
    Parameter by;
    double value, roll, z; // a place inside the blend
  };
  for (const auto &[of, by, value, roll, z] : { Case{ tip, Parameter::amount, 10e-3, 0.351, 0 },
                                                { tip, Parameter::start, 0.35, 0.3495, 0 },
                                                { root, Parameter::amount, 10e-3, 0.2995, 0 },
                                                { root, Parameter::start, 0.30, 0.3005, 0 },
                                                { end, Parameter::amount, 12e-3, 0.4, 6.04 },
                                                { end, Parameter::length, 4, 0.4, 5.97 },
                                                { bias, Parameter::amount, 20e-3, 0.351, -10.005 },
                                                { bias, Parameter::start, 0.35, 0.352, -9.97 },
                                                { bias, Parameter::length, 3, 0.352, -9.95 } })
    {
      const double step = 1e-6 * value, by_difference = (of.with(by, value + step)->removed(roll, z) -
                                                         of.with(by, value - step)->removed(roll, z)) /
                                                        (2 * step);
      ASSERT_GT(std::abs(by_difference), 0);
      EXPECT_NEAR(of.derivative(by, roll, z), by_difference, 1e-7 * std::abs(by_difference));
    }
}

TEST(Modification, UnloadedTransmissionErrorIsTheGeometricOne)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const double sap = pair.pinion_roll.start_of_active_profile, tip = pair.pinion_roll.tip,
               pitch = pair.pinion_roll.pitch_point, rb = pair.pinion.base_radius;
  using Pointer = std::shared_ptr<const FlankModification>;
  for (const Pointer &modification :
       { Pointer(std::make_shared<ProfileRelief>("tip relief", 10e-3, pitch, tip, ReliefShape::linear, rb)),
         Pointer(
             std::make_shared<ProfileRelief>("tip relief", 10e-3, pitch, tip, ReliefShape::quadratic, rb)),
         Pointer(std::make_shared<ProfileRelief>("root relief", 10e-3, pitch, sap, ReliefShape::linear, rb)),
         Pointer(
             std::make_shared<ProfileRelief>("root relief", 10e-3, pitch, sap, ReliefShape::quadratic, rb)),
         Pointer(std::make_shared<ProfileSlope>(6e-3, sap, tip)),
         Pointer(std::make_shared<ProfileCrown>(6e-3, sap, tip)),
         Pointer(std::make_shared<LeadCrown>(4e-3, 20)), Pointer(std::make_shared<HelixSlope>(6e-3, 20)),
         Pointer(std::make_shared<EndRelief>(5e-3, 6, 20, 0, ReliefShape::quadratic)),
         Pointer(std::make_shared<CornerBias>(1, 5e-3, 0.27, tip, 20, 20, -1, ReliefShape::linear, rb)),
         Pointer(std::make_shared<CornerBias>(4, 5e-3, 0.44, sap, 20, 20, -1, ReliefShape::quadratic, rb)) })
    for (const double phase : { 0.0, 0.3, 0.7 })
      {
        const double of_pinion = rigid_error(
                         pair, phase,
                         [&](double roll, double, double z) { return modification->removed(roll, z); }),
                     of_gear = rigid_error(pair, phase, [&](double, double mate, double z) {
                       return modification->removed(mate, z);
                     });
        // Sections 0.33 mm apart; contact moves off the path where the surface slopes: slope^2 R/2 < 3e-5 mm.
        EXPECT_NEAR(mesh_of(pair, on_pinion(modification)).unloaded(phase).theta * pair.pinion.base_radius,
                    of_pinion, 6e-5)
            << modification->describe(pair.pinion.base_radius);
        EXPECT_NEAR(mesh_of(pair, on_gear(modification)).unloaded(phase).theta * pair.pinion.base_radius,
                    of_gear, 6e-5)
            << modification->describe(pair.pinion.base_radius);
      }
}

TEST(Modification, SlopeOnThePinionIsTheOppositeOnTheGear)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const double sap = pair.pinion_roll.start_of_active_profile, tip = pair.pinion_roll.tip;
  // Profile: the pinion's tip meets the gear's root. Along z both are given on the same axis, so the same
  // amount opens the same gap; as a deviation of the helix angle that is the opposite one, and the gears of
  // one drawing (mirrored by `like`) cancel.
  const GearPair spur =
      make_gear_pair(paper_pair(0)); // one pair alone, on the path of action: outside it facing points differ
  const double a = te(spur, mesh_of(spur, on_pinion(std::make_shared<ProfileSlope>(1e-3, sap, tip)))
                                .solve(0.03, { 10e3 })[0]),
               b = te(spur, mesh_of(spur, on_gear(std::make_shared<ProfileSlope>(-1e-3, sap, tip)))
                                .solve(0.03, { 10e3 })[0]);
  EXPECT_NEAR(a, b, 1e-3); // um
  const double
      c = te(pair, mesh_of(pair, on_pinion(std::make_shared<HelixSlope>(8e-3, 20))).solve(0.3, { 150e3 })[0]),
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
  // Sections of a right-hand helix at +z are turned counter-clockwise, so they are ahead when the pinion
  // turns that way: contact leaves the tip last at -z. Left hand, or turning clockwise: at +z. The driven
  // gear's corner 1 is where contact enters at its tip.
  for (const bool right : { true, false })
    for (const bool counter : { true, false })
      {
        const ParallelAxisCase input =
            read("bias = [ { corner = 1, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]",
                 { std::string("pair.pinion_hand=") + (right ? "right" : "left"),
                   std::string("load.drive_flank=") + (counter ? "counter_clockwise" : "clockwise") });
        const double leaves = right == counter ? -10 : 10, tip = input.pair.pinion.tip_roll;
        EXPECT_NEAR(removed(input.deviations.pinion.modifications, tip, leaves), 5e-3, 1e-12);
        EXPECT_EQ(removed(input.deviations.pinion.modifications, tip, -leaves), 0);
        EXPECT_NEAR(removed(input.deviations.gear.modifications, tip, -leaves), 5e-3, 1e-12);
        EXPECT_EQ(removed(input.deviations.gear.modifications, tip, leaves), 0);
        // The coast flank drives when it turns the other way.
        EXPECT_NEAR(removed(input.coast.pinion.modifications, tip, -leaves), 5e-3, 1e-12);
        EXPECT_EQ(removed(input.coast.pinion.modifications, tip, leaves), 0);
      }
}

TEST(Bias, OutHarmsAtEveryTorqueAndInDoesNotForBothHandsAndSenses)
{
  for (const std::string hand : { "right", "left" })
    for (const std::string sense : { "counter_clockwise", "clockwise" })
      {
        const auto flank = [&](const std::string &corner) {
          return read(corner.empty() ? ""
                                     : "bias = [ { corner = " + corner +
                                           ", amount_um = 5, start_roll_angle_deg = 15, length_mm = 20 } ]",
                      { "pair.pinion_hand=" + hand, "load.drive_flank=" + sense });
        };
        const auto a1 = [&](const std::string &corner, const double torque) {
          const ParallelAxisCase input = flank(corner);
          return first_harmonic(mesh_of(input.pair, input.deviations), torque);
        };
        for (const double torque : { 100e3, 250e3 })
          {
            const double plain = a1("", torque);
            EXPECT_GT(a1("2", torque), 1.5 * plain) << hand << sense << torque;
            EXPECT_LT(a1("1", torque), plain) << hand << sense << torque;
            EXPECT_LT(a1("3", torque), plain) << hand << sense << torque; // corner 3 is bias-in too
          }
      }
}

TEST(Bias, AtHelixZeroTheLimitOfARightHandPinion)
{
  const ParallelAxisCase input =
      read("bias = [ { corner = 2, amount_um = 5, start_roll_angle_deg = 20, length_mm = 10 } ]",
           { "pair.helix_angle_deg=0", "pair.pinion_hand=left" });
  EXPECT_NEAR(removed(input.deviations.pinion.modifications, input.pair.pinion.tip_roll, 10), 5e-3, 1e-12);
}

TEST(Mirror, MirroredCaseGivesMirroredMapsAndTheSameTransmissionError)
{
  const std::string flanks =
                        "helix_slope = { amount_um = 4 }\nend_relief = { amount_um = 3, length_mm = 5, end = "
                        "\"positive_z\" }\n"
                        "bias = [ { corner = 2, amount_um = 5, start_roll_angle_deg = 16, length_mm = 15 } ]",
                    mirrored =
                        "helix_slope = { amount_um = -4 }\nend_relief = { amount_um = 3, length_mm = 5, end "
                        "= \"negative_z\" }\n"
                        "bias = [ { corner = 2, amount_um = 5, start_roll_angle_deg = 16, length_mm = 15 } ]";
  const ParallelAxisCase a = read(flanks, { "misalignment.in_plane_um=6" }),
                         b = read(mirrored, { "pair.pinion_hand=left", "misalignment.in_plane_um=-6" });
  for (const auto map : { pinion_modification, gear_modification, sum_of_modifications })
    EXPECT_LT((map(a.pair, a.deviations).value - map(b.pair, b.deviations).value.rowwise().reverse())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
  const PositionResult x = mesh_of(a.pair, a.deviations).solve(0.3, { 150e3 })[0],
                       y = mesh_of(b.pair, b.deviations).solve(0.3, { 150e3 })[0];
  EXPECT_NEAR(te(a.pair, x), te(b.pair, y), 1e-9);
  EXPECT_NEAR(x.load_centre, -y.load_centre, 1e-9);
  const Eigen::MatrixXd p = contact_pattern(a.pair, { x }, 15).value,
                        q = contact_pattern(b.pair, { y }, 15).value;
  EXPECT_GT(p.maxCoeff(), 100);
  EXPECT_LT((p - q.rowwise().reverse()).cwiseAbs().maxCoeff(), 1e-6);
}
