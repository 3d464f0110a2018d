// SPDX-License-Identifier: GPL-2.0-or-later
// Misalignment, mounting, single teeth, tip edges and extremes: rigid flanks in closed form, loaded
// identities.
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

using namespace flank;
using units::degree;
using units::micrometre;

TEST(Misalignment, RigidFlanksInClosedForm)
{
  // Spur: the gap opens by f z/b along the line of action, so the end at -z touches first.
  const double f = 12e-3;
  {
    const GearPair pair = make_gear_pair(paper_pair(0));
    MeshDeviations tilted;
    tilted.misalignment.in_plane = f / 20;
    EXPECT_NEAR(mesh_of(pair, tilted).unloaded(0.2).theta * pair.pinion.base_radius, -f / 2, 1e-9);
    const PositionResult loaded = mesh_of(pair, tilted).solve(0.2, { 100e3 })[0];
    EXPECT_LT(loaded.load_centre, -0.5);
    tilted.misalignment.in_plane = -f / 20;
    EXPECT_NEAR(mesh_of(pair, tilted).unloaded(0.2).theta * pair.pinion.base_radius, -f / 2, 1e-9);
    EXPECT_NEAR(mesh_of(pair, tilted).solve(0.2, { 100e3 })[0].load_centre, -loaded.load_centre,
                1e-4); // mm; as above
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
                              return f / 20 *
                                     (z * c + pair.pinion.base_radius * (roll - std::tan(20 * degree)) * s);
                            }),
                3e-6); // mm; sampled every 0.005 mm: f/20 0.005 mm
  // Across the plane of action nothing changes on it.
  MeshDeviations across;
  across.misalignment.across = f / 20;
  EXPECT_NEAR(mesh_of(pair, across).unloaded(0.4).theta * pair.pinion.base_radius, 0,
              1e-6); // mm; beside it, of second order
}

TEST(Mounting, SpringsTurnUntilMomentsBalance)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const double stiffness = 50e6; // N mm/rad
  Mounting soft;
  soft.tilt_in_plane = stiffness;
  const PositionResult sprung = mesh_of(pair, {}, soft).solve(0.3, { 150e3 })[0];
  const double s = std::sin(pair.base_helix_angle), c = std::cos(pair.base_helix_angle);
  double moment = 0;
  for (std::size_t i = 0; i < sprung.cell_forces.size(); ++i)
    {
      const GridCell &cell = (*sprung.grid_cells)[i];
      moment += sprung.cell_forces[i] * (cell.z * c + pair.pinion.base_radius * cell.pinion_roll * s);
    }
  EXPECT_NEAR(-sprung.tilt[0] * stiffness, moment,
              2e-3 *
                  moment); // the closed form holds on the plane of action; 14 % of the load is at tip edges
  EXPECT_GT(-sprung.tilt[0], 1e-4);
  // The same tilt imposed on rigid mountings: the same contact; only the pivot differs, which adds to the
  // transmission error.
  MeshDeviations tilted;
  tilted.misalignment.in_plane = -sprung.tilt[0];
  const PositionResult imposed = mesh_of(pair, tilted).solve(0.3, { 150e3 })[0];
  const double pivot = -sprung.tilt[0] * s * pair.pinion.base_radius * std::tan(20 * degree) / c;
  EXPECT_NEAR(te(pair, sprung), te(pair, imposed) + pivot / micrometre,
              2e-3); // windows are sized a little differently
  EXPECT_NEAR(sprung.load_centre, imposed.load_centre, 5e-3);
}

TEST(Mounting, TiltsOfBothAxesActAsTheirMisalignment)
{
  // Whatever turns by however much: the contact is that of the misalignment given, pinion against gear.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  Mounting pinion, gear;
  pinion.tilt_in_plane = 300e6, pinion.tilt_across = 90e6; // N mm/rad
  gear.tilt_in_plane = 70e6, gear.tilt_across = 200e6;
  const PositionResult sprung = mesh_of(pair, {}, pinion, gear).solve(0.3, { 150e3 })[0];
  MeshDeviations tilted;
  tilted.misalignment = { .in_plane = sprung.tilt[2] - sprung.tilt[0],
                          .across = sprung.tilt[3] - sprung.tilt[1] };
  EXPECT_GT(std::abs(tilted.misalignment.in_plane), 1e-4);
  EXPECT_GT(std::abs(tilted.misalignment.across), 1e-4);
  const PositionResult imposed = mesh_of(pair, tilted).solve(0.3, { 150e3 })[0];
  // mm; windows are sized a little differently. A tilt with another sign moves it by more than 1 mm.
  EXPECT_NEAR(sprung.load_centre, imposed.load_centre, 0.02);
  EXPECT_NEAR(sprung.max_line_load, imposed.max_line_load, 5e-3 * imposed.max_line_load);
}

TEST(Mounting, SpringsThatTakeTheBacklashAreNoSolution)
{
  // The same tilt is one too much whether it is given or springs make it.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const auto failure = [&](const double stiffness, const double torque, const bool both = false) {
    Mounting soft, other;
    soft.tilt_across = stiffness;
    if (both)
      other.tilt_across = stiffness;
    LoadedPair mesh = mesh_of(pair, {}, soft, other);
    mesh.coast = std::make_shared<const CoastFlanks>();
    PositionCompliance compliance = mesh.compliance();
    const SlicedPosition at = mesh.at(0.3);
    return mesh.solve_all(at, { torque, 1e-3 * torque }, { 0 }, compliance).front();
  };
  const auto stiff = failure(1e9, 150e3);
  EXPECT_TRUE(stiff[0].failure.empty()) << stiff[0].failure;
  const double tilt = 1e9 * stiff[0].tilt[1]; // N mm
  MeshDeviations given;
  double low = 0, high = 0.1; // of the tilt at which the backlash is gone [rad]
  while (high - low > 1e-6)
    {
      given.misalignment.across = (low + high) / 2;
      (backlash_taken(pair, given, {}).sum() > backlash_to_take(pair) ? high : low) =
          given.misalignment.across;
    }
  EXPECT_TRUE(failure(std::abs(tilt) / (0.95 * low), 150e3)[0].failure.empty());
  const auto soft = failure(std::abs(tilt) / (1.05 * high), 150e3);
  EXPECT_NE(soft[0].failure.find("the other flanks would touch"), std::string::npos) << soft[0].failure;
  EXPECT_TRUE(soft[1].failure.empty()) << soft[1].failure; // a torque that tilts little is not lost with it
  // Equal springs of both gears turn them the same way: nothing of the backlash is taken.
  const auto together = failure(std::abs(tilt) / (1.05 * high), 150e3, true);
  EXPECT_TRUE(together[0].failure.empty()) << together[0].failure;
  EXPECT_NEAR(together[0].tilt[3] / together[0].tilt[1], 1, 0.05);
}

TEST(Mounting, TorsionIsASpringInSeries)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  Mounting pinion, gear;
  pinion.torsion = 2e8, gear.torsion = 3e8;
  // One pair alone, on the path of action, so that neither gear's lever varies.
  const PositionResult rigid = mesh_of(pair).solve(0.05, { 30e3 })[0],
                       sprung = mesh_of(pair, {}, pinion, gear).solve(0.05, { 30e3 })[0];
  EXPECT_NEAR(sprung.theta - rigid.theta, 30e3 / 2e8 + 30e3 / 3e8, 1e-9 * 30e3 / 2e8);
  EXPECT_NEAR(1 / sprung.stiffness, 1 / rigid.stiffness + 1 / 2e8 + 1 / 3e8, 1e-9 / 2e8);
}

TEST(SingleTeeth, RunoutAndIndexErrorsOfRigidFlanks)
{
  // Unloaded spur pair: an eccentricity e moves the transmission error by e cos(rotation); a tooth that
  // stands back changes nothing while a neighbour carries, and a tooth that stands out carries alone.
  const GearPair pair = make_gear_pair(paper_pair(0));
  MeshDeviations run;
  run.pinion.runout = 20e-3;
  run.pinion.runout_angle = 0.7;
  for (const int cycle : { 0, 7, 31 })
    for (const double phase : { 0.0, 0.4 })
      EXPECT_NEAR(mesh_of(pair, run).unloaded(phase, cycle).theta * pair.pinion.base_radius,
                  10e-3 * std::cos((cycle + phase) * 2 * units::pi / 50 - 0.7), 1e-9);
  MeshDeviations index;
  index.gear.index_errors.assign(50, 0);
  index.gear.index_errors[3] = -5e-3;
  const LoadedPair mesh = mesh_of(pair, index);
  EXPECT_NEAR(mesh.unloaded(0, 3).theta * pair.pinion.base_radius, -5e-3, 1e-9); // tooth 3 at the pitch point
  EXPECT_NEAR(mesh.unloaded(0.9, 2).theta * pair.pinion.base_radius, -5e-3,
              1e-9); // the same tooth a tenth of a pitch before
  EXPECT_NEAR(mesh.unloaded(0, 53).theta * pair.pinion.base_radius, -5e-3, 1e-9); // again after a revolution
  EXPECT_NEAR(mesh.unloaded(0, 8).theta * pair.pinion.base_radius, 0, 1e-9);
  // A cycle's result is its own, whatever other cycles are computed with it.
  const auto all = mesh.solve(0.8, { 100e3 }, { 0, 3, 8 });
  EXPECT_EQ(te(pair, all[1][0]), te(pair, mesh.solve(0.8, { 100e3 }, { 3 })[0][0]));
  EXPECT_GT(std::abs(te(pair, all[0][0]) - te(pair, all[1][0])), 0.5);
}

TEST(TipEdge, ChamferAndRoundingEndTheInvolute)
{
  PairData data = paper_pair(0);
  data.pinion.tip_chamfer = 0.4;
  const GearPair chamfered = make_gear_pair(data);
  EXPECT_NEAR(chamfered.pinion.usable_tip_radius(), 77.6, 1e-9);
  PairData shorter = paper_pair(0);
  shorter.pinion.tip_radius = 77.6;
  EXPECT_NEAR(chamfered.transverse_contact_ratio, make_gear_pair(shorter).transverse_contact_ratio, 1e-12);
  // Contact past the end of the involute is that of the shorter tooth: same slices, levers and first touches.
  const GearPair cut = make_gear_pair(shorter);
  const MeshDeviations none;
  const auto a = MeshPosition(chamfered, none, 0.9).slices(5), b = MeshPosition(cut, none, 0.9).slices(5);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      EXPECT_NEAR(a[i].touch, b[i].touch, 1e-12);
      EXPECT_NEAR(a[i].lever, b[i].lever, 1e-9);
    }
  // The arc is tangent to the involute: no step, no kink, curvature 1/radius; and to the tip circle.
  data.pinion.tip_chamfer = 0;
  data.pinion.tip_rounding = 0.3;
  const GearPair round = make_gear_pair(data);
  const double rb = round.pinion.base_radius, u = round.pinion.usable_tip_roll;
  EXPECT_NEAR(std::pow(78 - 0.3, 2), rb * rb + std::pow(rb * u - 0.3, 2), 1e-9);
  const MeshPosition sharp_position(cut, none, 0.9), round_position(round, none, 0.9);
  const auto gap = [&](const double along) {
    const double roll = std::sqrt(u * u + 2 * along / rb);
    return round_position.facing(1, roll, 0).separation -
           MeshPosition(make_gear_pair(paper_pair(0)), none, 0.9).facing(1, roll, 0).separation;
  };
  EXPECT_NEAR(gap(-0.01), 0, 1e-12);
  EXPECT_NEAR(gap(0.05), 0.3 - std::sqrt(0.09 - 0.0025), 1e-9);
  // Of a helical tooth the arc lies in the transverse section, the gap along the normal.
  PairData oblique = paper_pair(25.232);
  const GearPair sharp_helical = make_gear_pair(oblique);
  oblique.pinion.tip_rounding = 0.3;
  const GearPair helical = make_gear_pair(oblique);
  const double at_helical =
      std::sqrt(std::pow(helical.pinion.usable_tip_roll, 2) + 2 * 0.05 / helical.pinion.base_radius);
  EXPECT_NEAR(MeshPosition(helical, none, 0.9).facing(1, at_helical, 0).separation -
                  MeshPosition(sharp_helical, none, 0.9).facing(1, at_helical, 0).separation,
              (0.3 - std::sqrt(0.09 - 0.0025)) * std::cos(helical.base_helix_angle), 1e-9);
  // The gear's tip, where it meets the pinion's root: on the path of action only the rounding parts them.
  PairData other = paper_pair(0);
  other.gear.tip_rounding = 0.3;
  const GearPair mated = make_gear_pair(other);
  const double at_root = std::tan(20 * degree) - 0.85 * 2 * units::pi / 50;
  const FacingPoints facing = MeshPosition(mated, none, 0.15).facing(-1, at_root, 0);
  const double along = rb / 2 * (facing.gear_roll * facing.gear_roll - u * u);
  EXPECT_GT(along, 0.05); // mm
  EXPECT_NEAR(facing.separation, 0.3 - std::sqrt(0.09 - along * along), 1e-9);
  // Under load the rounded tooth lies between the full one and one that ends where the rounding starts.
  PairData ends = paper_pair(0);
  ends.pinion.tip_chamfer = 78 - round.pinion.usable_tip_radius();
  const GearPair full = make_gear_pair(paper_pair(0)), end = make_gear_pair(ends);
  const double low = te(full, mesh_of(full).solve(0.93, { 200e3 })[0]),
               high = te(end, mesh_of(end).solve(0.93, { 200e3 })[0]),
               between = te(round, mesh_of(round).solve(0.93, { 200e3 })[0]);
  EXPECT_LT(low, high);
  EXPECT_GT(between, low);
  EXPECT_LT(between, high);
}

TEST(TipEdge, SlicesOnARoundingScaleWithThePairToTheBit)
{
  PairData data = unequal_pair(), large = data;
  const auto rounded = [](PairData &pair, const double scale) {
    pair.centre_distance *= scale;
    pair.transverse_module *= scale;
    for (GearData *gear : { &pair.pinion, &pair.gear })
      {
        for (double *length : { &gear->face_width, &gear->tip_radius, &gear->root_radius,
                                &gear->tooth_thickness, &gear->bore_radius, &gear->fillet_radius })
          *length *= scale;
        gear->tip_rounding = 0.4 * scale;
      }
  };
  rounded(data, 1);
  rounded(large, 4);
  const MeshDeviations none;
  int on_a_rounding = 0;
  for (const double phase : { 0.0, 0.25, 0.6 })
    {
      const GearPair pair = make_gear_pair(data), larger = make_gear_pair(large);
      const auto a = MeshPosition(pair, none, phase).slices(16),
                 b = MeshPosition(larger, none, phase).slices(16);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i)
        {
          on_a_rounding += a[i].tip_edge;
          EXPECT_EQ(b[i].pinion_roll, a[i].pinion_roll) << phase << " " << i;
          EXPECT_EQ(b[i].gear_roll, a[i].gear_roll) << phase << " " << i;
          EXPECT_EQ(b[i].touch, 4 * a[i].touch) << phase << " " << i;
          EXPECT_EQ(b[i].touch_offset, 4 * a[i].touch_offset) << phase << " " << i;
        }
    }
  EXPECT_GT(on_a_rounding, 10);
}

TEST(TipEdge, UnmodifiedSpurPairGrowsSmoothlyAndHasNoJumps)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const LoadedPair mesh = mesh_of(pair, {}, {}, {}, 5);
  double before = 0, step_before = 0;
  for (const double torque : { 75e3, 150e3, 225e3, 300e3, 375e3, 450e3 })
    {
      const double now = first_harmonic(mesh, torque, 32);
      EXPECT_GT(now, before) << torque;
      if (step_before > 0)
        {
          EXPECT_LT(now - before, 1.2 * step_before)
              << torque; // it saturates; without tip contact it would go on in proportion
        }
      step_before = now - before;
      before = now;
    }
  // Where the incoming pair touches at its tip edge: steps shrink with the positions, as they would not at a
  // jump.
  const auto greatest_step = [&](const double step) {
    double greatest = 0, last = te(pair, mesh.solve(0.86, { 300e3 })[0]);
    for (double phase = 0.86 + step; phase < 0.95; phase += step)
      {
        const double now = te(pair, mesh.solve(phase, { 300e3 })[0]);
        greatest = std::max(greatest, std::abs(now - last));
        last = now;
      }
    return greatest;
  };
  const double coarse = greatest_step(0.01), fine = greatest_step(0.001);
  EXPECT_LT(fine,
            0.15 * coarse); // ten times the positions: a tenth, where the transmission error is continuous
}

TEST(Extreme, LargeReliefAndAllLoadOnOneCornerStayCertified)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  MeshDeviations deviations;
  const double tip = pair.pinion.tip_roll;
  deviations.pinion.modifications = { std::make_shared<ProfileRelief>("tip relief", 0.3, 18 * degree, tip,
                                                                      ReliefShape::linear,
                                                                      pair.pinion.base_radius),
                                      std::make_shared<LeadCrown>(0.1, 20) };
  deviations.gear.modifications = deviations.pinion.modifications;
  for (const double phase : { 0.0, 0.4 })
    EXPECT_TRUE(mesh_of(pair, deviations).solve(phase, { 5e3, 300e3 })[0].certificate.holds());
  // Everything but one corner stands back.
  MeshDeviations corner;
  corner.misalignment.in_plane = 0.4 / 20;
  corner.pinion.modifications = { std::make_shared<ProfileSlope>(
      -0.2, pair.pinion_roll.start_of_active_profile, tip) };
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
      even.lines.push_back({ 0, -8 + 4.0 * s, 0.36, 100, 500, 0.1, 4 });
      slanted.lines.push_back({ 0, -8 + 4.0 * s, 0.36, 100.0 * s, 500, 0.1, 4 });
    }
  EXPECT_NEAR(face_load_factor(pair, { even }, 5), 1, 1e-12);
  even.lines[2] = { 0, -1, 0.36, 100, 500, 0.1, 2 }; // two halves of a slice are the slice
  even.lines.push_back({ 0, 1, 0.36, 100, 500, 0.1, 2 });
  EXPECT_NEAR(face_load_factor(pair, { even }, 5), 1, 1e-12);
  EXPECT_NEAR(face_load_factor(pair, { slanted }, 5), 2, 1e-12);
  // A crowned pair under load: line loads and cells sum to the torque, by symmetry nothing shuttles on a spur
  // pair.
  const PositionResult result =
      mesh_of(pair, on_pinion(std::make_shared<LeadCrown>(10e-3, 20))).solve(0, { 100e3 })[0];
  double total = 0;
  for (const LineLoad &line : result.lines)
    total += line.load_per_length * line.height;
  EXPECT_NEAR(total * pair.pinion.base_radius, 100e3, 1); // all on the path of action at phase 0
  EXPECT_NEAR(result.load_centre, 0, 1e-5);               // mm; the two ends' near fields are tabulated apart
  EXPECT_GT(face_load_factor(pair, { result }, small_grid.slices), 1.2);
}

// What errors of single teeth take of the backlash is not left to the springs: a tooth that stands out
// between teeth that do not, and an axis that runs out both ways.
TEST(Mounting, SingleTeethTakeTheirBacklashBeforeTheSprings)
{
  ParallelAxisCase input{};
  input.pair = make_gear_pair(paper_pair(0));
  input.cycles = 50;
  input.pinion_mounting.tilt_in_plane = 1e9;
  const std::shared_ptr<const BodyCompliance> body(std::shared_ptr<void>(), &small_body(0)); // owns nothing
  const std::vector bodies(2, body);
  const auto taken = [&] { return loaded_pair(input, bodies).coast->taken_otherwise; };
  EXPECT_EQ(taken(), 0);
  input.deviations.pinion.index_errors.assign(50, 0);
  input.deviations.pinion.index_errors[7] = -8e-3;
  EXPECT_NEAR(taken(), 8e-3, 1e-12);
  input.deviations.gear.runout = 20e-3;
  EXPECT_GT(taken(), 8e-3 + 2e-3);
  input.deviations.pinion.index_errors.clear();
  EXPECT_GT(taken(), 2e-3);
}

// Either gear's springs alone let its axis tilt.
TEST(Mounting, OneSpringOfEitherGearIsATilt)
{
  ParallelAxisCase input{};
  EXPECT_FALSE(input.has_tilt_springs());
  for (Mounting ParallelAxisCase::*mounting :
       { &ParallelAxisCase::pinion_mounting, &ParallelAxisCase::gear_mounting })
    for (double Mounting::*tilt : { &Mounting::tilt_in_plane, &Mounting::tilt_across })
      {
        ParallelAxisCase sprung{};
        (sprung.*mounting).*tilt = 1e6;
        EXPECT_TRUE(sprung.has_tilt_springs());
      }
}
