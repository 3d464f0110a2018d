// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/harmonics.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/small_mesh.hpp"

#include <gtest/gtest.h>

#include <array>

using namespace flank;
using units::degree;

namespace
{
  FlankModifications relief(const Gear &gear, const double amount_um, const double start_deg,
                            const double crown_um)
  {
    return { std::make_shared<ProfileRelief>("tip relief", amount_um * 1e-3, start_deg * degree,
                                             gear.tip_roll, ReliefShape::linear, gear.base_radius),
             std::make_shared<LeadCrown>(crown_um * 1e-3, gear.face_width) };
  }

  LoadedPair loaded_mesh(const GearPair &pair, const FlankModifications &pinion_flank,
                         const FlankModifications &gear_flank, const BodyCompliance &pinion,
                         const BodyCompliance &gear, const ContactGridSize &grid)
  {
    LoadedPair mesh = small_loaded_pair(pair, pinion, gear, {}, grid);
    mesh.deviations.pinion.modifications = pinion_flank;
    mesh.deviations.gear.modifications = gear_flank;
    return mesh;
  }

  double own_compliance(const BodyCompliance &body, const Gear &gear, const Patch &patch)
  {
    return compliance_of(body, { patch }, { patch }, gear.flank())(0, 0);
  }
} // namespace

TEST(Unloaded, UnmodifiedPairHasNoTransmissionError)
{
  for (const double helix : { 0.0, 25.232 })
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      const LoadedPair mesh = loaded_mesh(pair, {}, {}, small_body(25.232), small_body(25.232), small_grid);
      for (const double phase : { 0.0, 0.21, 0.5, 0.83 })
        EXPECT_NEAR(mesh.unloaded(phase).theta * pair.pinion.base_radius, 0, 1e-9); // mm
    }
}

TEST(Unloaded, ModifiedSpurPairHasTheGeometricTransmissionError)
{
  // Contact moves to where the sum of the reliefs is least; mid-face has no crown. On the line of action the
  // pinion's roll angle at the pair k is known, so the geometric error is the least removal over the pairs in
  // mesh.
  const GearPair pair = make_gear_pair(paper_pair(0));
  const FlankModifications p = relief(pair.pinion, 10, 20.9, 4), g = relief(pair.gear, 10, 20.9, 4);
  const LoadedPair mesh = loaded_mesh(pair, p, g, small_body(25.232), small_body(25.232), small_grid);
  for (const double phase : { 0.0, 0.1, 0.35, 0.5 })
    {
      double least = 1e9;
      for (int k = -2; k <= 2; ++k)
        {
          const double roll = pair.pinion_roll.pitch_point + (phase + k) * pair.pinion.pitch_angle(),
                       mate = 2 * pair.pinion_roll.pitch_point - roll;
          if (roll <= pair.pinion.tip_roll && mate <= pair.gear.tip_roll)
            least = std::min(least, removed(p, roll, 0) + removed(g, mate, 0));
        }
      const double found = mesh.unloaded(phase).theta * pair.pinion.base_radius;
      EXPECT_LE(found, least + 1e-12);
      EXPECT_NEAR(found, least,
                  1e-4); // surfaces touch beside the line of action where the relief slopes: slope^2 R / 2 =
                         // (10 um / 3.24 mm)^2 12.8 mm / 2 = 6e-5 mm, more at small radii
    }
}

TEST(Unloaded, ModifiedHelicalPairHasTheGeometricTransmissionError)
{
  // The least removal along the lines of contact on the plane of action, sampled without any of the scene's
  // code.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const FlankModifications m = relief(pair.pinion, 10, 20.9, 4);
  const LoadedPair mesh = loaded_mesh(pair, m, m, small_body(25.232), small_body(25.232), { 41, 11 });
  for (const double phase : { 0.0, 0.3, 0.7 })
    {
      double least = 1e9;
      for (int k = -3; k <= 3; ++k)
        for (double z = -10; z <= 10; z += 0.01)
          {
            const double roll = std::tan(20 * degree) + (phase + k) * 2 * units::pi / 50 +
                                z * std::tan(25.232 * degree) / 75,
                         mate = 2 * std::tan(20 * degree) - roll;
            if (roll <= pair.pinion.tip_roll && mate <= pair.gear.tip_roll)
              least = std::min(least,
                               (removed(m, roll, z) + removed(m, mate, z)) / std::cos(pair.base_helix_angle));
          }
      const double found = mesh.unloaded(phase).theta * pair.pinion.base_radius;
      EXPECT_LE(found, least + 2e-5);  // mm: slices half a millimetre apart miss at most 2e-5 of the crown
      EXPECT_NEAR(found, least, 1e-4); // the touching point beside the line of action, as above
    }
}

TEST(Loaded, SeamClosesAndPhaseOneIsTheNextTooth)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const FlankModifications m = relief(pair.pinion, 5, 22.2, 2);
  const LoadedPair mesh = loaded_mesh(pair, m, m, small_body(25.232), small_body(25.232), small_grid);
  const auto start = mesh.solve(0, { 200e3 }), end = mesh.solve(1, { 200e3 });
  EXPECT_NEAR(te(pair, start[0]), te(pair, end[0]), 1e-6); // um
  EXPECT_NE(start[0].pairs.front().pair, end[0].pairs.front().pair);
  EXPECT_NEAR(start[0].gear_torque, 200e3, 1e-3 * 200e3); // teeth 1:1; tip-edge slices differ in lever
}

TEST(Loaded, EveryHandAndDirectionOfDriveIsAMirrorImage)
{
  PairData data = paper_pair(25.232);
  std::vector<double> values, places;
  for (const Hand hand : { Hand::right, Hand::left })
    for (const bool ccw : { true, false })
      {
        data.pinion_hand = hand;
        data.counter_clockwise_drive = ccw;
        const GearPair pair = make_gear_pair(data);
        const FlankModifications m = relief(pair.pinion, 5, 22.2, 2);
        const LoadedPair mesh = loaded_mesh(pair, m, m, small_body(25.232), small_body(25.232), small_grid);
        const auto result = mesh.solve(0.3, { 150e3 });
        values.push_back(te(pair, result[0]));
        places.push_back(result[0].max_pressure_z);
      }
  for (const double value : values)
    EXPECT_NEAR(value, values[0], 1e-9);
  EXPECT_NEAR(places[0], -places[1], 1e-9); // right ccw, right cw
  EXPECT_NEAR(places[0], -places[2], 1e-9); // left ccw
  EXPECT_NEAR(places[0], places[3], 1e-9);  // left cw
}

TEST(Loaded, PinionAndGearExchanged)
{
  // The same contact seen from the other side: torque times the ratio of base radii, path of action run
  // backwards.
  const PairData data = unequal_pair();
  PairData swapped = data;
  std::swap(swapped.pinion, swapped.gear);
  swapped.pinion.name = "pinion";
  swapped.gear.name = "gear";
  swapped.pinion_hand = Hand::left;
  const GearPair pair = make_gear_pair(data), other = make_gear_pair(swapped);
  const BodyCompliance pinion(pair.pinion, small_sector(), 6), gear(pair.gear, small_sector(), 6);
  const LoadedPair mesh = loaded_mesh(pair, {}, {}, pinion, gear, small_grid),
                   exchanged = loaded_mesh(other, {}, {}, gear, pinion, small_grid);
  const double torque = 150e3, ratio = pair.gear.base_radius / pair.pinion.base_radius;
  for (const double phase : { 0.15, 0.6 })
    {
      const double a = te(pair, mesh.solve(phase, { torque })[0]),
                   b = te(other, exchanged.solve(-phase, { torque * ratio })[0]);
      EXPECT_NEAR(a, b, 2e-3 * a); // levers of tip-edge slices and gaps in the window's corners are taken
                                   // from the pinion's side
    }
}

TEST(Loaded, EnergyIsTheWorkOfTheTorque)
{
  // External work = strain energy 1/2 f'Cf = 1/2 sum f (theta l - g): along the whole loading path of one
  // mesh position.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const FlankModifications m = relief(pair.pinion, 5, 22.2, 2);
  const LoadedPair mesh = loaded_mesh(pair, m, m, small_body(25.232), small_body(25.232), small_grid);
  std::vector<double> torques;
  for (int i = 1; i <= 200; ++i)
    torques.push_back(200e3 * i * i / 40000.0);
  const auto results = mesh.solve(0.3, torques);
  double work = 0, elastic = results.back().torque * results.back().theta;
  for (std::size_t i = 0; i < results.back().cell_forces.size(); ++i)
    elastic -= results.back().cell_forces[i] * (*results.back().grid_cells)[i].gap;
  elastic /= 2;
  for (std::size_t i = 1; i < results.size(); ++i)
    work += 0.5 * (results[i].torque + results[i - 1].torque) * (results[i].theta - results[i - 1].theta);
  EXPECT_NEAR(work, elastic, 1e-3 * elastic); // trapezoidal rule with 200 steps
  EXPECT_GT(results.back().gear_torque, 0);
}

TEST(Loaded, EveryDegreeOfElementConvergesOnTheSameTransmissionError)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  std::vector<double> error;
  for (const int degree : { 1, 2, 3 })
    {
      SectorResolution size = small_sector();
      size.degree = degree;
      const BodyCompliance body(pair.pinion, size, 6);
      const LoadedPair mesh = loaded_mesh(pair, {}, {}, body, body, small_grid);
      error.push_back(te(pair, mesh.solve(0.3, { 200e3 })[0]));
    }
  EXPECT_LT(std::abs(error[1] - error[2]),
            0.2 * std::abs(error[0] - error[2])); // quadratic against linear elements of the same mesh
  EXPECT_NEAR(error[1], error[2],
              0.01 * error[2]); // 1.7 to 2.2 % of the bending part at 23k unknowns
}

TEST(Loaded, BothSplitsAgreeInTransmissionError)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const FlankModifications none;
  const BodyCompliance classical(pair.pinion, small_sector(), 6, { Split::classical });
  const LoadedPair a = loaded_mesh(pair, none, none, small_body(25.232), small_body(25.232), small_grid),
                   b = loaded_mesh(pair, none, none, classical, classical, small_grid);
  const double projected_te = te(pair, a.solve(0.25, { 200e3 })[0]),
               classical_te = te(pair, b.solve(0.25, { 200e3 })[0]);
  EXPECT_NEAR(classical_te, projected_te,
              0.03 * projected_te); // own-patch errors of the classical split are 2 to 8 % of the near part
  EXPECT_NE(classical_te, projected_te);
  const BodyCompliance line_fit(pair.pinion, small_sector(), 6,
                                { Split::classical, ClassicalDepth::line_fit });
  const LoadedPair c = loaded_mesh(pair, none, none, line_fit, line_fit, small_grid);
  EXPECT_NEAR(te(pair, c.solve(0.25, { 200e3 })[0]), projected_te, 0.03 * projected_te);
}

TEST(Loaded, NeighbouringTorqueBandsAgreeAtTheirBorder)
{
  // The default grid: a torque at the low end of its band against the same torque on a grid of its own.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const FlankModifications m = relief(pair.pinion, 10, 20.9, 4);
  const LoadedPair mesh = loaded_mesh(pair, m, m, small_body(25.232), small_body(25.232), {});
  for (const double phase : { 0.0, 0.25, 0.6 })
    EXPECT_NEAR(te(pair, mesh.solve(phase, { 209e3, 100e3 })[1]), te(pair, mesh.solve(phase, { 100e3 })[0]),
                0.005); // um, the design's bound
}

TEST(Patches, OwnComplianceOfLargePatchesIsThatOfThePlainElements)
{
  // A patch over many elements needs no near field: what the half-space adds, the same elements take away.
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const InvoluteHelicoid flank = pair.pinion.flank();
  const auto &s = small_body(25.232).far_field().surface;
  const double roll = std::sqrt(0.5 * (s.q_tip + s.q_form));
  const auto own = [&](const double a, const double b) {
    Patch patch{ 0, {}, roll, 0, a, b };
    for (const auto &[x, y] : { std::pair{ -a, -b }, { a, -b }, { a, b }, { -a, b } })
      patch.outline.emplace_back(std::pow(roll + y * flank.roll_per_generator(), 2) +
                                     2 * x / pair.pinion.base_radius,
                                 y * flank.cos_base_helix());
    const double with_near_field = own_compliance(small_body(25.232), pair.pinion, patch);
    const PatchWeights weights(s, { patch });
    const auto nodes = weights.nodes(0);
    const auto values = weights.values(0);
    double elements_alone = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = 0; j < nodes.size(); ++j)
        elements_alone +=
            values[i] * values[j] * small_body(25.232).far_field().by_tooth_offset[0](nodes[i], nodes[j]);
    return (with_near_field - elements_alone) / with_near_field;
  };
  EXPECT_GT(own(0.05, 0.3), 0.2);    // a quarter of the compliance is near field
  EXPECT_NEAR(own(1.5, 5), 0, 0.02); // patch of 3 x 10 mm on elements of 1.1 x 3.3 mm
  EXPECT_GT(own(0.05, 0.3), 10 * own(1.5, 5));
}

TEST(Patches, TabulatedNearFieldIsTheDirectOne)
{
  // Interior, tip edge, both face ends, corners; places between the table's points, down to a hundredth of an
  // element from an edge.
  const Gear gear = make_gear_pair(paper_pair(25.232)).pinion;
  const BodyElements elements(gear, small_sector());
  const FlankSurface surface = flank_surface(elements.sector());
  const FlankEdges ends(gear);
  for (const auto &[row, layer] :
       { std::pair{ 3, 3 }, { 0, 3 }, { 3, 0 }, { 3, 5 }, { 0, 0 }, { 0, 5 }, { 1, 1 }, { 5, 2 } })
    {
      const FlankBlock block = elements.blocks().around(row, row, layer, layer);
      const SourceTable table = make_source_table(block, surface, gear, ends, row, row, layer, layer);
      for (const double u : { -0.45, 0.01, 0.13, 0.5, 0.77, 0.99, 1.45 })
        for (const double v : { -0.45, 0.01, 0.31, 0.66, 0.99, 1.45 })
          {
            // Patches reach up to half an element beyond those that name the block.
            if (row + u < 0 || row + u > surface.rows || layer + v < 0 || layer + v > surface.layers)
              continue;
            const Eigen::VectorXd direct =
                response_to_source(block, surface, gear, ends, table.free, row + u, layer + v);
            SourceTable::ColumnWeights weights;
            weights.reset(table);
            weights.add({ row + u }, layer + v, { 1 });
            // Within a tenth of an element of an edge the split itself is good to some percent.
            const bool edge = (row == 0 && u < 0.1) || (layer == 0 && v < 0.1) || (layer == 5 && v > 0.9);
            EXPECT_LT((table.source_response * weights.weight() - direct).norm(),
                      (edge ? 0.03 : 1.5e-3) * direct.norm())
                << row << " " << layer << " " << u << " " << v;
          }
    }
}

TEST(Patches, ASpurGearsNearFieldIsAlikeAtBothEnds)
{
  const Gear gear = make_gear_pair(paper_pair(0)).pinion;
  const BodyElements elements(gear, small_sector());
  const FlankSurface surface = flank_surface(elements.sector());
  const FlankEdges ends(gear);
  const auto made = [&](const int row, const int layer) {
    return make_source_table(elements.blocks().around(row, row, layer, layer), surface, gear, ends, row, row,
                             layer, layer);
  };
  const int last = surface.layers - 1;
  for (const auto &[row, layer] : { std::pair{ 0, 0 }, { 2, 1 }, { 3, 2 } })
    {
      const SourceTable one = mirrored(made(row, layer), surface.layers), other = made(row, last - layer);
      EXPECT_EQ(one.first_layer, other.first_layer);
      EXPECT_EQ(one.last_layer, other.last_layer);
      EXPECT_EQ(one.free, other.free);
      ASSERT_EQ(one.layer.breaks.size(), other.layer.breaks.size());
      for (std::size_t k = 0; k < one.layer.breaks.size(); ++k)
        EXPECT_NEAR(one.layer.breaks[k], other.layer.breaks[k], 1e-12);
      EXPECT_LT((one.load_response - other.load_response).norm(), 1e-10 * other.load_response.norm());
      EXPECT_LT((one.source_response - other.source_response).norm(), 1e-10 * other.source_response.norm());
    }
}

TEST(Convergence, OwnComplianceTransmissionErrorAndPeakPressureUnderMeshRefinement)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const InvoluteHelicoid flank = pair.pinion.flank();
  std::vector<double> own, error, pressure;
  for (const int level : { 0, 1, 2 })
    {
      SectorResolution size;
      size.flank_rows = std::array{ 5, 8, 12 }[level], size.tooth_columns = std::array{ 4, 6, 8 }[level],
      size.face_layers = std::array{ 5, 8, 12 }[level];
      size.rim_layers = 6; // the rim is the same at all levels
      const BodyCompliance body(pair.pinion, size, 6);
      const double roll = 21.6 * degree;
      Patch patch{ 0, {}, roll, 1.7, 0.1, 0.5 };
      for (const auto &[x, y] : { std::pair{ -0.1, -0.5 }, { 0.1, -0.5 }, { 0.1, 0.5 }, { -0.1, 0.5 } })
        patch.outline.emplace_back(std::pow(roll + y * flank.roll_per_generator(), 2) +
                                       2 * x / pair.pinion.base_radius,
                                   1.7 + y * flank.cos_base_helix());
      own.push_back(own_compliance(body, pair.pinion, patch));
      const LoadedPair mesh = loaded_mesh(pair, {}, {}, body, body, { 21, 11 });
      const auto result = mesh.solve(0.3, { 200e3 })[0];
      error.push_back(te(pair, result));
      pressure.push_back(result.max_pressure);
    }
  EXPECT_NEAR(own[1], own[2],
              2e-3 * own[2]); // 0.2 %: inside the flank the split leaves less than 0.1 %, the meshes' far
                              // fields differ by as much
  EXPECT_LT(std::abs(own[1] - own[2]), std::abs(own[0] - own[2]));
  EXPECT_NEAR(error[1], error[2], 5e-3 * error[2]); // the required accuracy of the mean
  EXPECT_LT(std::abs(error[1] - error[2]), std::abs(error[0] - error[2]));
  EXPECT_NEAR(pressure[1], pressure[2], 0.01 * pressure[2]);
}

TEST(TorqueBands, AreOctavesWhateverElseIsComputed)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const double unit =
      effective_modulus(pair) * std::pow(pair.data.transverse_module, 2) * pair.common_face_width;
  std::vector<double> torques = { 1.2, 0, 7.9, 1.9, 4.1, 0.9 };
  for (double &torque : torques)
    torque *= unit;
  const std::vector<std::vector<int>> bands = { { 2, 4 }, { 3, 0 }, { 5 } };
  EXPECT_EQ(torque_bands(pair, torques), bands);
}

TEST(Harmonics, OfACosine)
{
  std::vector<double> values;
  for (int k = 0; k < 16; ++k)
    values.push_back(3 + 0.5 * std::cos(2 * units::pi * k / 16 + 0.3) +
                     0.2 * std::cos(6 * units::pi * k / 16 - 1));
  const auto list = harmonics(values);
  EXPECT_NEAR(list[0].amplitude, 0.5, 1e-14);
  EXPECT_NEAR(list[0].phase, 0.3, 1e-13);
  EXPECT_NEAR(list[1].amplitude, 0, 1e-14);
  EXPECT_NEAR(list[2].amplitude, 0.2, 1e-14);
}
