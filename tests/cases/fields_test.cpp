// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/fields/body_field.hpp"
#include "cases/parallel_axis/fields/root_stress.hpp"
#include "mesh/base/units.hpp"
#include "tests/cases/small_mesh.hpp"
#include "tests/example_pairs.hpp"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

using namespace flank;

// Both hands, both senses of drive: where the solver says that flanks touch, the placed bodies must touch, normal against normal.
TEST(Fields, PlacedBodiesTouchWhereTheContactIs)
{
  for (const double helix : { 0.0, 25.232 })
    for (const Hand hand : { Hand::right, Hand::left })
      for (const bool counter_clockwise : { true, false })
        {
          PairData data                = paper_pair(helix);
          data.pinion_hand             = hand;
          data.counter_clockwise_drive = counter_clockwise;
          data.gear.teeth              = 50;
          data.axial_offset            = 1.5;
          const GearPair       pair    = make_gear_pair(data);
          const MeshDeviations none;
          for (const double phase : { 0.0, 0.37 })
            {
              int                touching = 0;
              const MeshPosition position(pair, none, phase);
              for (const Slice &slice : position.slices(7))
                if (!slice.tip_edge && slice.separation < 1e-9)
                  {
                    ++touching;
                    const Placement pinion = of_tooth(pinion_placement(pair, phase), pair.pinion, slice.pair),
                                    gear   = of_tooth(gear_placement(pair, phase), pair.gear, -slice.pair);
                    const double gear_z    = canonical_z_sign(data) * data.axial_offset - slice.z;
                    const auto   of_pinion = pair.pinion.flank().frame(slice.pinion_roll, slice.z),
                               of_gear     = pair.gear.flank().frame(slice.gear_roll, gear_z);
                    EXPECT_LT((pinion.point(of_pinion.origin) - gear.point(of_gear.origin)).norm(), 1e-9); // rounding of 150 mm
                    EXPECT_NEAR(pinion.vector(of_pinion.inward).dot(gear.vector(of_gear.inward)), -1, 1e-12);
                  }
              EXPECT_GE(touching, 7);
            }
          EXPECT_NEAR(gear_placement(pair, 0).offset.z(), data.axial_offset, 1e-12);
        }
}

TEST(Fields, SurfaceDataAndFlankLoadsSumToTheSolversForces)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const auto    &body = small_body(25.232);
  LoadedMesh     mesh{ { pair, body, body, small_grid, {}, {} }, {} };
  mesh.keep_cells             = true;
  const PositionResult result = mesh.solve(0.3, { 2e5 }).front();
  double               force = 0, of_field[2] = { 0, 0 }, torque = 0;
  for (const PairLoad &load : result.pairs)
    force += load.force;
  const FieldPiece field = contact_field(pair, result);
  for (const Eigen::MatrixXd &cell : field.cells)
    of_field[cell(7, 0) == 1 ? 0 : 1] += cell(3, 0) * cell(6, 0); // pressure times area
  EXPECT_NEAR(of_field[0], force, 1e-12 * force);
  EXPECT_NEAR(of_field[1], force, 1e-12 * force);
  for (const Side side : { Side::pinion, Side::gear })
    for (const auto &[tooth, load] : flank_loads(body.far_field().surface, result, side))
      for (const PairLoad &of_pair : result.pairs)
        if (of_pair.pair == (side == Side::pinion ? tooth : -tooth))
          EXPECT_NEAR(load.sum(), of_pair.force, 1e-12 * force);
  // No gap where there is force, no force where there is a gap.
  for (Eigen::Index i = 0; i < result.contact_gap.size(); ++i)
    {
      EXPECT_LT(std::abs(result.contact_gap[i] * result.contact_force[i]), 1e-12 * force);
      EXPECT_GT(result.contact_gap[i], -1e-12);
      torque += result.contact_force[i] * (*result.contact_cells)[static_cast<std::size_t>(i)].lever;
    }
  EXPECT_NEAR(torque, 2e5, 1e-6);
}

// A spur pair at the pitch point: one line contact with the radii of the involutes there.
TEST(Fields, StressBelowASpurContactIsHertzs)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const auto    &body = small_body(0);
  LoadedMesh     mesh{ { pair, body, body, small_grid, {}, {} }, {} };
  EXPECT_EQ(mesh.solve(0, { 2e5 }).front().subsurface.shear, 0); // nobody asked
  mesh.subsurface_stress      = true;
  const PositionResult result = mesh.solve(0, { 2e5 }).front();
  ASSERT_EQ(result.pairs.size(), 1u);
  double line_load = 0; // where the greatest pressure is
  for (const LineLoad &line : result.lines)
    if (std::abs(line.z - result.max_pressure_z) < 1e-9)
      line_load = line.load_per_length;
  const double modulus = 207e3 / (1 - 0.09) / 2, radius = pair.pinion.base_radius * std::tan(pair.working_pressure_angle) / 2;
  const double half_width = std::sqrt(4 * line_load * radius / (units::pi * modulus)), peak = 2 * line_load / (units::pi * half_width);
  // Eleven cells over the window, seven of them loaded: their means broaden the contact.
  EXPECT_NEAR(result.subsurface.shear, 0.30028 * peak, 0.02 * 0.30028 * peak);
  EXPECT_NEAR(result.subsurface.shear_depth, 0.78615 * half_width, 0.04 * 0.78615 * half_width);
  EXPECT_NEAR(result.subsurface.von_mises, 0.5577 * peak, 0.02 * 0.5577 * peak);
}

// A body under one and the same stress everywhere: every point of both fillets must say its greatest principal stress.
TEST(Fields, FilletsOfAUniformlyStretchedSector)
{
  const Gear         gear = make_gear_pair(paper_pair(25.232)).pinion;
  const BodyElements elements(gear, small_sector());
  const ElasticBody &body = elements.body();
  Eigen::Matrix3d    strain;
  strain << 1e-3, 4e-4, -2e-4, 4e-4, -5e-4, 3e-4, -2e-4, 3e-4, 2e-4;
  Eigen::VectorXd displacement(body.n_unknowns());
  for (int node = 0; node < body.n_nodes(); ++node)
    displacement.segment<3>(3 * node) = strain * body.node_positions()[node];
  const double mu                = gear.youngs_modulus / (2 * (1 + gear.poissons_ratio)),
               lambda            = 2 * mu * gear.poissons_ratio / (1 - 2 * gear.poissons_ratio);
  const Eigen::Matrix3d stress   = 2 * mu * strain + lambda * strain.trace() * Eigen::Matrix3d::Identity();
  const double          greatest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(stress).eigenvalues()[2];
  for (const auto &side : fillet_stress(elements, displacement))
    {
      EXPECT_EQ(side.size(), 13u); // six layers of degree 2
      for (const double value : side)
        EXPECT_NEAR(value, greatest, 1e-8 * greatest); // isoparametric elements hold a linear field exactly
    }
}

// Bending of a tooth as a beam: where the load moves up the tooth the root stress grows as its lever, and the other fillet is pressed.
TEST(Fields, RootStressFollowsTheLeverOfTheLoad)
{
  const Gear          gear = make_gear_pair(paper_pair(0)).pinion;
  const BodyElements  elements(gear, small_sector());
  const FlankSurface  surface = flank_surface(elements.sector());
  const LoadedTeeth   teeth(elements, BodyModel{});
  std::vector<double> lever, tension;
  for (const int row : { 0, 2, 4 })
    {
      Eigen::VectorXd force = Eigen::VectorXd::Zero(surface.n_nodes());
      for (int k = 0; k < surface.n_layer_nodes(); ++k)
        force[surface.node(row, k)] = (k == 0 || k == surface.n_layer_nodes() - 1 ? 1
                                       : k % 2                                    ? 4
                                                                                  : 2) *
                                      1000.0 / (6 * surface.layers); // Simpson
      const auto stress = fillet_stress(elements, teeth.displacements({ { 0, force } }, { 0 })[0]);
      // The normal's line meets the tooth's centre line at r_b / cos(half angle + roll - ...): the lever is its height over the root.
      const double roll = std::sqrt(surface.q_at(row)), angle = roll - gear.half_angle_at_base; // of the force against the tooth's side
      lever.push_back((gear.base_radius / std::cos(angle) - gear.form_radius) * std::cos(angle));
      tension.push_back(stress[0][stress[0].size() / 2]);
      EXPECT_LT(stress[1][stress[1].size() / 2], 0.3 * tension.back());
    }
  EXPECT_GT(tension[0], tension[1]);
  EXPECT_GT(tension[1], tension[2]);
  // Radial pressure and the fillet's own height under the lever take some off: within a fifth of proportional.
  EXPECT_NEAR((tension[0] / tension[2]) / (lever[0] / lever[2]), 1, 0.2);
}
