// SPDX-License-Identifier: GPL-2.0-or-later
// What is computed once and used often: switched off, nothing changes. (Cache, ranks, threads and resuming:
// command_line.sh; one process or many for a reduction: distributed_test.)
#include "contact/matching/body_size.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "solver/elements/flank_block.hpp"
#include "tests/contact/small_mesh.hpp"

#include <fmt/format.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace flank;

namespace
{
  FlankModifications relief(const Gear &gear)
  {
    return { std::make_shared<ProfileRelief>("tip relief", 10e-3, 0.37, gear.tip_roll, ReliefShape::linear,
                                             gear.base_radius),
             std::make_shared<LeadCrown>(4e-3, gear.face_width) };
  }

  LoadedPair mesh_of(const GearPair &pair, const BodyCompliance &pinion, const BodyCompliance &gear)
  {
    LoadedPair mesh = small_loaded_pair(pair, pinion, gear);
    mesh.deviations.pinion.modifications = relief(pair.pinion);
    mesh.deviations.gear.modifications = relief(pair.gear);
    return mesh;
  }

  /// One mesh position of the helical pair at 200 N m, its grid built.
  struct LoadedPosition
  {
    GearPair pair = make_gear_pair(paper_pair(25.232));
    LoadedPair mesh = mesh_of(pair, small_body(25.232), small_body(25.232));
    SlicedPosition sliced = mesh.at(0.3);
    PositionCompliance compliance{ small_body(25.232), small_body(25.232), pair.pinion.flank() };
    PositionGrid grid{ mesh.bodies, sliced.position, compliance, sliced.in_reach(0.02), 0, 200e3 };
    LoadedPosition() { grid.build(grid.windows()); }
  };
} // namespace

TEST(Economy, OneBodyForBothGears)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const BodyCompliance again(pair.gear, small_sector(), 6);
  const LoadedPair shared = mesh_of(pair, small_body(25.232), small_body(25.232)),
                   separate = mesh_of(pair, small_body(25.232), again);
  EXPECT_NEAR(te(pair, shared.solve(0.4, { 100e3 })[0]), te(pair, separate.solve(0.4, { 100e3 })[0]), 1e-9);
}

TEST(Economy, HalfASpurBody)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  BodyModel whole;
  whole.use_mid_plane = false;
  const BodyCompliance of_whole(pair.pinion, small_sector(), 6, {}, whole);
  ASSERT_TRUE(has_mid_plane(pair.pinion, small_sector()));
  for (const double phase : { 0.1, 0.6 })
    EXPECT_NEAR(te(pair, mesh_of(pair, small_body(0), small_body(0)).solve(phase, { 100e3 })[0]),
                te(pair, mesh_of(pair, of_whole, of_whole).solve(phase, { 100e3 })[0]),
                1e-7); // um, 1e-10 mm: rounding of two condensations
}

TEST(Economy, OneBlockForAllLayersAwayFromTheEnds)
{
  const Gear gear = make_gear_pair(paper_pair(25.232)).pinion;
  SectorResolution size = small_sector();
  size.face_layers = 9;
  const BodyElements elements(gear, size);
  const FlankSurface surface = flank_surface(elements.sector());
  ASSERT_EQ(layer_shift(surface, 5, 5), layer_shift(surface, 4, 4) - 1); // both stand for the same
  const FlankEdges ends(gear);
  const int stands_for = 5 + layer_shift(surface, 5, 5);
  const FlankBlock a = elements.blocks().around(2, 2, stands_for, stands_for),
                   b = elements.blocks().around(2, 2, 5, 5);
  const Eigen::VectorXd p = response_to_source(a, surface, gear, ends, {}, 2.3, stands_for + 0.6),
                        q = response_to_source(b, surface, gear, ends, {}, 2.3, 5.6);
  EXPECT_LT((a.load_response - b.load_response).norm(), 1e-9 * a.load_response.norm());
  EXPECT_LT((p - q).norm(), 1e-9 * p.norm());
}

TEST(Economy, OneSweepForAllTorquesOfABand)
{
  LoadedPosition position;
  PositionGrid &grid = position.grid;
  const std::vector<double> torques{ 200e3, 170e3, 140e3, 110e3 };
  const auto together = SimplexSolver(grid.problem()).sweep(torques, grid.expected_contact());
  const auto unaided = SimplexSolver(grid.problem()).sweep(torques, {});
  for (std::size_t t = 0; t < torques.size(); ++t)
    {
      EXPECT_NEAR(together[t].theta, SimplexSolver(grid.problem()).solve(torques[t]).theta,
                  1e-9 * together[t].theta);
      EXPECT_NEAR(together[t].theta, unaided[t].theta,
                  1e-9 * together[t].theta); // without the expected contact as a start
    }
}

TEST(Economy, OneGridForTorquesWithoutAnInfluenceOnEachOther)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const LoadedPair mesh = mesh_of(pair, small_body(25.232), small_body(25.232));
  std::vector<double> torques;
  for (int k = 0; k < 24; ++k)
    torques.push_back(5e3 * std::pow(1.25, k));
  int fewest = 1000, most = 0;
  for (const double phase : { 0.0, 0.3, 0.6 })
    {
      const std::vector<PositionResult> all = mesh.solve(phase, torques);
      for (std::size_t t = 0; t < torques.size(); ++t)
        {
          const PositionResult alone = mesh.solve(phase, { torques[t] }).front();
          EXPECT_NEAR(all[t].theta, alone.theta, 1e-12 * alone.theta); // another order of operations
          EXPECT_NEAR(all[t].max_pressure, alone.max_pressure, 1e-9 * alone.max_pressure);
          EXPECT_EQ(all[t].cells, alone.cells);
          EXPECT_EQ(all[t].grids, alone.grids);
          fewest = std::min(fewest, alone.grids), most = std::max(most, alone.grids);
        }
    }
  EXPECT_EQ(fewest, 1); // some on their octave's grid, some not
  EXPECT_GT(most, 1);
}

TEST(Economy, AFewCellsAreNotNarrowedAndWidenedAgain)
{
  // The coarser grids of error estimates have seven cells. Narrowed windows of so few end in a loaded cell:
  // each was widened again, which gave the first grid a second time.
  const GearPair pair = make_gear_pair(paper_pair(0));
  LoadedPair mesh = mesh_of(pair, small_body(0), small_body(0));
  mesh.bodies.grid.profile_cells = 7;
  int grids = 0;
  for (const double phase : { 0.0, 0.3, 0.6 })
    for (int k = 0; k < 12; ++k) // an octave
      grids += mesh.solve(phase, { 50e3 * std::exp2(k / 12.0) }).front().grids;
  EXPECT_LE(grids, 60); // of 36 contacts: 56 where some widen or resolve, 66 with those that do so in vain
}

TEST(Economy, OneGridForTorquesThatGoOnToTheSame)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const LoadedPair mesh = mesh_of(pair, small_body(25.232), small_body(25.232));
  int together = 0;
  for (const double phase : { 0.0, 0.3, 0.6 })
    for (int k = 0; k < 24; ++k)
      {
        const SlicedPosition sliced = mesh.at(phase);
        PositionCompliance compliance = mesh.compliance();
        const double torque = 5e3 * std::pow(1.25, k);
        std::vector<std::size_t> found;
        solve_on_fitted_grids(mesh.bodies, sliced, { torque, 0.9999 * torque }, 0, compliance,
                              [&](const FittedGrid &fitted) {
                                found.insert(found.end(), fitted.torques.begin(), fitted.torques.end());
                                together += fitted.torques.size() == 2 && fitted.grid.windows().grids > 1;
                              });
        EXPECT_EQ(std::set(found.begin(), found.end()), std::set<std::size_t>({ 0, 1 }));
        EXPECT_EQ(found.size(), 2U); // each once
      }
  EXPECT_GT(together, 5); // of 72 pairs of torques that want nearly the same
}

TEST(Economy, SlicesOfAGridAreKnownBeforeItsCompliance)
{
  // Memory is planned by them: a spur pair has three tooth pairs in reach at some phases, two at others.
  std::set<std::size_t> of_spur;
  for (const double helix : { 0.0, 25.232 })
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      const LoadedPair mesh = mesh_of(pair, small_body(helix), small_body(helix));
      int compared = 0;
      for (const double phase : { 0.0, 0.3, 0.6, 0.9 })
        for (const double torque : { 30e3, 300e3 })
          {
            PositionCompliance compliance = mesh.compliance();
            solve_on_fitted_grids(
                mesh.bodies, mesh.at(phase), { torque }, 0, compliance, [&](const FittedGrid &fitted) {
                  const std::size_t slices = fitted.grid.slices().size();
                  if (fitted.grid.windows().grids > 1)
                    return; // it may have taken others
                  ++compared;
                  const std::vector<FirstGrid> expected =
                      first_grids(pair, mesh.deviations, mesh.bodies.grid.slices, { 1e3, torque }, phase);
                  EXPECT_EQ(expected.back().slices, static_cast<int>(slices))
                      << helix << " " << phase << " " << torque;
                  EXPECT_LE(expected.front().slices, expected.back().slices);
                  if (helix == 0)
                    of_spur.insert(slices);
                });
          }
      EXPECT_GT(compared, 2);
    }
  EXPECT_GT(of_spur.size(), 1U);
}

TEST(Economy, EndsCountWhereContactComesNearThem)
{
  // What a plan leaves out plays no part: the same numbers with half-spaces at the ends. (Of rounded tips,
  // which are no edges.)
  PairData data = paper_pair(0);
  data.pinion.tip_rounding = data.gear.tip_rounding = 0.2;
  const GearPair pair = make_gear_pair(data);
  SectorResolution size = small_sector();
  size.face_layers = 14;
  const BodyCompliance free(pair.pinion, size, 6), half_space(pair.pinion, size, 6, { .free_ends = false });
  const double block_to_end = (block_rings + 1) * pair.pinion.face_width / size.face_layers;
  const auto compared = [&](const double crown, const double torque) {
    double te[2];
    for (const bool ends : { false, true })
      {
        const BodyCompliance &body = ends ? free : half_space;
        LoadedPair mesh = small_loaded_pair(pair, body, body);
        mesh.deviations.pinion.modifications = { std::make_shared<LeadCrown>(crown, pair.pinion.face_width) };
        te[ends] = transmission_error(pair, mesh.solve(0.3, { torque })[0]);
      }
    MeshDeviations deviations;
    deviations.pinion.modifications = { std::make_shared<LeadCrown>(crown, pair.pinion.face_width) };
    const FirstGrid grid = first_grids(pair, deviations, small_grid.slices, { torque }, 0.3).front();
    EXPECT_NEAR(grid.to_ends[0], grid.to_ends[1], 1e-12); // a crown is symmetric
    return std::pair(grid.to_ends[0] < block_to_end, te[1] != te[0]);
  };
  EXPECT_EQ(compared(1, 10e3), (std::pair(false, false)));
  EXPECT_EQ(compared(5e-3, 100e3), (std::pair(true, true)));
}

TEST(Economy, OneComplianceForAllMeshCycles)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const LoadedPair mesh = mesh_of(pair, small_body(25.232), small_body(25.232));
  const auto all = mesh.solve(0.3, { 100e3 }, { 0, 7, 31 }); // every tooth the same
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(te(pair, all[c][0]), te(pair, mesh.solve(0.3, { 100e3 })[0]), 1e-9);
}

TEST(Economy, OneSetOfHalfSpacePotentialsForBothBodies)
{
  // Both half-spaces carry the same rectangles, in one plane: their distances along the pinion's flank. Along
  // the gear's they differ in second order of the curvature.
  LoadedPosition position;
  const GearPair &pair = position.pair;
  PositionGrid &grid = position.grid;
  std::vector<Patch> pinion, gear;
  for (const ContactCell &cell : grid.cells())
    pinion.push_back(cell.pinion), gear.push_back(cell.gear);
  const BodyCompliance &body = small_body(25.232);
  ContactProblem own = grid.problem();
  const auto on_pinion = compliance_of(body, pinion, pinion, pair.pinion.flank());
  own.compliance = on_pinion + compliance_of(body, gear, gear, pair.gear.flank());
  const double shared = SimplexSolver(grid.problem()).solve(200e3).theta,
               separate = SimplexSolver(own).solve(200e3).theta;
  EXPECT_NEAR(shared, separate, 1e-4 * separate); // 2e-5: a choice of model, neither is exact

  // As an economy: two sets on the same plane instead of one.
  own.compliance = on_pinion + compliance_of(body, gear, pinion, pair.pinion.flank());
  EXPECT_NEAR(shared, SimplexSolver(own).solve(200e3).theta, 1e-9 * shared);
}

TEST(Economy, OneComplianceForAllTorquesAndModificationsOfAPosition)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  LoadedPair mesh = mesh_of(pair, small_body(25.232), small_body(25.232));
  PositionCompliance kept(small_body(25.232), small_body(25.232), pair.pinion.flank());
  const auto modified = mesh.deviations;
  mesh.deviations = {};
  mesh.solve(mesh.at(0.3), { 150e3 }, { 0 }, kept); // unmodified, another torque
  mesh.deviations = modified;
  mesh.solve(mesh.at(0.3), { 300e3 }, { 0 }, kept);
  const PositionResult with = mesh.solve(mesh.at(0.3), { 200e3 }, { 0 }, kept)[0][0],
                       without = mesh.solve(0.3, { 200e3 }, { 0 })[0][0];
  EXPECT_EQ(with.theta, without.theta); // the same operations in the same order
  EXPECT_EQ(with.cell_forces, without.cell_forces);
}

TEST(Economy, OneComplianceWhateverReliefsTheTipEdgesHave)
{
  // Beyond the path of action, where cells are graded towards a tip edge: reliefs move the contact from it.
  const GearPair pair = make_gear_pair(paper_pair(0));
  LoadedPair mesh = mesh_of(pair, small_body(0), small_body(0));
  for (const double phase : { 0.08, 0.12, 0.88, 0.92 })
    {
      PositionCompliance kept(small_body(0), small_body(0), pair.pinion.flank());
      for (const double before_tip : { 0.0, 0.04, 0.05, 0.06, 0.08 })
        {
          mesh.deviations = {};
          if (before_tip > 0)
            for (auto [flanks, gear] : { std::pair{ &mesh.deviations.pinion, &pair.pinion },
                                         { &mesh.deviations.gear, &pair.gear } })
              flanks->modifications = { std::make_shared<ProfileRelief>(
                  "tip relief", 5e-3, gear->tip_roll - before_tip * units::degree, gear->tip_roll,
                  ReliefShape::linear, gear->base_radius) };
          const PositionResult with = mesh.solve(mesh.at(phase), { 200e3 }, { 0 }, kept)[0][0],
                               without = mesh.solve(phase, { 200e3 }, { 0 })[0][0];
          EXPECT_EQ(with.theta, without.theta) << phase << " " << before_tip;
          EXPECT_EQ(with.cell_forces, without.cell_forces) << phase << " " << before_tip;
        }
    }
}

TEST(Economy, TabulatedNearFieldLeavesTheTransmissionErrorAlone)
{
  // Not exact as the others: the tables are a discretisation, here against ones of 8 points on intervals half
  // as long.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const BodyCompliance &coarse = small_body(25.232);
  const FlankSurface &surface = coarse.far_field().surface;
  const BodyElements elements(pair.pinion, small_sector());
  ProjectedSplit::Tables fine;
  const FlankEdges ends(pair.pinion);
  const FlankEdges::Faces faces = ends.faces();
  for (const auto &[key, table] : coarse.projected()->tables())
    {
      const auto [row_a, row_b, layer_a, layer_b] = key;
      fine[key] = std::make_shared<const SourceTable>(
          make_source_table(elements.blocks().around(row_a, row_b, layer_a, layer_b), surface, pair.pinion,
                            ends, row_a, row_b, layer_a, layer_b, { 8, 0.4 }));
    }
  const BodyCompliance finer(pair.pinion, small_sector(), {}, coarse.far_field(), coarse.n_unknowns(), fine,
                             &faces);
  double worst = 0;
  for (const double phase : { 0.05, 0.3, 0.55, 0.8 })
    {
      const double a = te(pair, mesh_of(pair, coarse, coarse).solve(phase, { 100e3 })[0]),
                   b = te(pair, mesh_of(pair, finer, finer).solve(phase, { 100e3 })[0]);
      worst = std::max(worst, std::abs(a - b));
    }
  EXPECT_LT(worst, 1e-5); // um; the mesh itself is good to 0.02 um
  RecordProperty("difference_um", fmt::format("{:.2e}", worst));
}

TEST(Reduction, BySizeUnlessTheCaseSays)
{
  using enum BodyModel::Reduction;
  SectorResolution large;
  large.flank_rows = 100, large.face_layers = 400, large.rim_layers = 150; // terabytes
  BodyModel model;
  EXPECT_EQ(reduction_of(model, small_sector(), 1), condensed);
  EXPECT_EQ(reduction_of(model, small_sector(), 4), condensed);
  EXPECT_EQ(reduction_of(model, large, 1), condensed); // nobody to share it with
  EXPECT_EQ(reduction_of(model, large, 4), distributed);
  for (const auto asked : { condensed, distributed, direct })
    {
      model.reduction = asked;
      EXPECT_EQ(reduction_of(model, large, 4), asked);
    }
}
