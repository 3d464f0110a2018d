// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/body_elements.hpp"
#include "solver/linear/direct_solver.hpp"
#include "solver/linear/layered_cholesky.hpp"
#include "solver/reduction/flank_compliance.hpp"
#include "solver/reduction/tooth_responses.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

#include <thread>

using namespace flank;

// A run whose bodies come from the cache needs the elements of both in the middle of its contacts, from
// whichever thread asks first.
TEST(BodyElements, OfTwoBodiesAreMadeByTwoThreadsAtOnce)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  SectorResolution size;
  size.face_layers = 3;
  const auto places_of = [&](const Gear &gear) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const BodyElements elements(gear, size);
    for (const Eigen::Vector3d &place : elements.body().node_positions())
      sum += place;
    return sum;
  };
  const Eigen::Vector3d pinion = places_of(pair.pinion), gear = places_of(pair.gear);
  for (int round = 0; round < 20; ++round)
    {
      Eigen::Vector3d other;
      std::jthread thread([&] { other = places_of(pair.gear); });
      EXPECT_EQ(places_of(pair.pinion), pinion);
      thread.join();
      EXPECT_EQ(other, gear);
    }
}

TEST(Rim, LayersAreThinToTheRootAndToASmallBore)
{
  for (const double bore : { 0.07, 0.15, 0.3, 0.6, 0.9 })
    for (const int layers : { 10, 20 })
      {
        PairData data = paper_pair(0);
        data.pinion.bore_radius = bore * make_gear_pair(data).pinion.root_radius;
        const Gear gear = make_gear_pair(data).pinion;
        SectorResolution size;
        size.face_layers = 2, size.rim_layers = layers;
        const ToothSector sector = make_tooth_sector(gear, size); // throws where gmsh has other nodes
        const auto radius = [&](const int layer) {
          return sector.section.vertices()[sector.section.rim_vertex(0, layer)].norm();
        };
        EXPECT_NEAR(radius(0), gear.root_radius, 1e-9);
        EXPECT_NEAR(radius(layers), gear.bore_radius, 1e-9);
        EXPECT_LT(radius(0) - radius(1), 1.3 * data.transverse_module / 4); // of an element of the tooth
        for (int l = 1; l < layers; ++l)
          {
            const double before = radius(l - 1) - radius(l), after = radius(l) - radius(l + 1);
            EXPECT_GT(after, 0.4 * before) << bore << " " << layers;
            EXPECT_LT(after, 2.5 * before) << bore << " " << layers;
          }
        EXPECT_LT(radius(layers - 1), 1.8 * gear.bore_radius) << bore << " " << layers;
      }
}

// However thick a rim, its first layer is as thick as the tooth's elements ask for, and the last ones halve.
TEST(Rim, ThickOnesHaveMoreLayers)
{
  int before = 0;
  for (const double bore : { 0.9, 0.5, 0.02 })
    {
      PairData data = paper_pair(0);
      data.pinion.bore_radius = bore * make_gear_pair(data).pinion.root_radius;
      const Gear gear = make_gear_pair(data).pinion;
      SectorResolution size;
      size.face_layers = 2, size.flank_rows = 24, size.rim_layers = 6;
      size.rim_layers = enough_rim_layers(gear, size);
      EXPECT_GE(size.rim_layers, std::max(6, before)) << bore;
      before = size.rim_layers;
      const ToothSection section(gear, size);
      const auto radius = [&](const int layer) {
        return section.vertices()[section.rim_vertex(0, layer)].norm();
      };
      const double row = 0.5 * gear.base_radius * (std::pow(gear.tip_roll, 2) - std::pow(gear.form_roll, 2)) /
                         size.flank_rows;
      EXPECT_LT(radius(0) - radius(1), 1.201 * row) << bore;
      const int n = size.rim_layers;
      EXPECT_NEAR((radius(n - 1) - radius(n)) / (radius(n - 2) - radius(n - 1)), 0.5, 1e-9) << bore;
    }
  EXPECT_GT(before, 7);
}

namespace
{
  /// A small gear and a mesh whose whole body can be solved directly.
  SectorResolution coarse(const int degree, const int layers = 2)
  {
    SectorResolution size;
    size.degree = degree, size.flank_rows = 3, size.tooth_columns = 2, size.face_layers = layers,
    size.fillet_rows = 1, size.fillet_columns = 1, size.rim_layers = 2;
    return size;
  }

  BodyModel body_model(const BodyModel::Kind kind, const bool clamped, const BodyModel::Reduction reduction,
                       const bool mid_plane)
  {
    return { kind, 5, clamped, reduction, mid_plane };
  }

  double difference(const FlankCompliance &a, const FlankCompliance &b)
  {
    EXPECT_EQ(a.by_tooth_offset.size(), b.by_tooth_offset.size());
    EXPECT_EQ(a.by_depth.size(), b.by_depth.size());
    double worst = 0;
    for (std::size_t m = 0; m < a.by_tooth_offset.size(); ++m)
      worst = std::max(worst, (a.by_tooth_offset[m] - b.by_tooth_offset[m]).cwiseAbs().maxCoeff());
    for (std::size_t d = 0; d < a.by_depth.size(); ++d)
      worst = std::max(worst, (a.by_depth[d] - b.by_depth[d]).cwiseAbs().maxCoeff());
    return worst / a.by_tooth_offset[0].cwiseAbs().maxCoeff();
  }
} // namespace

class Bodies : public testing::TestWithParam<double>
{
};

TEST_P(Bodies, CondensedRingAndSegmentEqualTheWholeBodySolvedDirectly)
{
  using enum BodyModel::Kind;
  const Gear gear = make_gear_pair(twelve_tooth_pair(GetParam())).pinion;
  for (const int degree : { 1, 2 })
    {
      const BodyElements elements(gear, coarse(degree));
      EXPECT_GT(elements.body().least_scaled_jacobian(), 0.05);
      for (const auto &[kind, clamped] : { std::pair{ ring, false }, { segment, false }, { segment, true } })
        {
          const FlankCompliance condensed = flank_compliance(
                                    elements,
                                    body_model(kind, clamped, BodyModel::Reduction::condensed, false), 6),
                                direct = flank_compliance(
                                    elements, body_model(kind, clamped, BodyModel::Reduction::direct, false),
                                    6);
          EXPECT_LT(difference(condensed, direct), 1e-8)
              << degree; // same discrete model, two factorisations; off-diagonal teeth included
          const Eigen::MatrixXd &self = condensed.by_tooth_offset[0];
          EXPECT_LT((self - self.transpose()).cwiseAbs().maxCoeff(), 1e-12 * self.cwiseAbs().maxCoeff());
          // Half way round the ring both ways are the same tooth: reciprocity makes the operator symmetric.
          const Eigen::MatrixXd &opposite = condensed.by_tooth_offset[6];
          EXPECT_LT((opposite - opposite.transpose()).cwiseAbs().maxCoeff(),
                    1e-10 * self.cwiseAbs().maxCoeff());
          if (kind == segment)
            {
              EXPECT_GT(condensed.by_tooth_offset[2].cwiseAbs().maxCoeff(), 0);
              EXPECT_EQ(condensed.by_tooth_offset[3].cwiseAbs().maxCoeff(), 0); // outside the five teeth
            }
        }
    }
}
INSTANTIATE_TEST_SUITE_P(SpurAndHelical, Bodies, testing::Values(0.0, 20.0));

TEST_P(Bodies, RingInRealNumbersIsTheComplexOne)
{
  const Gear gear = make_gear_pair(twelve_tooth_pair(GetParam())).pinion;
  for (const auto &[degree, depth] : { std::pair{ 1, 0 }, { 2, 0 }, { 2, 1 } })
    {
      const BodyElements elements(gear, coarse(degree));
      CondensedSector sector =
          condense_sector(elements.sector(), elements.body(), MidPlane::none, depth, nullptr);
      ASSERT_TRUE(sector.symmetry.has_value());
      const std::vector<TeethLoads> loads{ { { 0, Eigen::VectorXd::Ones(sector.n_flank()) },
                                             { 2, Eigen::VectorXd::LinSpaced(sector.n_flank(), -1, 2) } } };
      const ToothResponses real = ring_responses(sector, gear.teeth, 6);
      const CutDisplacements real_cuts = ring_cuts(sector, gear.teeth, loads, { 0, 1 });
      sector.symmetry.reset();
      const ToothResponses complex = ring_responses(sector, gear.teeth, 6);
      const CutDisplacements complex_cuts = ring_cuts(sector, gear.teeth, loads, { 0, 1 });
      for (std::size_t m = 0; m < complex.size(); ++m)
        EXPECT_LT((real[m] - complex[m]).cwiseAbs().maxCoeff(), 1e-11 * complex[0].cwiseAbs().maxCoeff())
            << m; // rounding
      for (const int tooth : { 0, 1 })
        EXPECT_LT((real_cuts[0].at(tooth).plus - complex_cuts[0].at(tooth).plus).norm(),
                  1e-11 * complex_cuts[0].at(tooth).plus.norm());
    }
}

TEST(LayeredCholesky, IsTheDenseOne)
{
  // Layers of unequal size, an empty one, coupled one or two layers on.
  const std::vector<Eigen::Index> size{ 3, 5, 0, 4, 7, 2 };
  const std::vector<int> last{ 2, 2, 4, 4, 5, 5 };
  LayeredCholesky layered(size, last);
  const Eigen::Index n = layered.begin(layered.n_layers());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (int t = 0; t < layered.n_layers(); ++t)
    {
      auto &panel = layered.panel(t);
      for (Eigen::Index j = 0; j < panel.cols(); ++j)
        for (Eigen::Index i = j; i < panel.rows(); ++i)
          panel(i, j) = i == j ? 12 : std::sin(3.0 * i + 7.0 * j + t); // diagonally dominant
      dense.block(layered.begin(t), layered.begin(t), panel.rows(), panel.cols()) += panel;
    }
  dense.triangularView<Eigen::StrictlyUpper>() = dense.transpose();
  Eigen::MatrixXd x(n, 2);
  x << Eigen::VectorXd::LinSpaced(n, -1, 1), Eigen::VectorXd::Ones(n);
  const Eigen::MatrixXd expected = dense.llt().solve(x);
  ASSERT_TRUE(layered.factor());
  layered.solve_in_place(x);
  EXPECT_LT((x - expected).norm(), 1e-14 * n * expected.norm());

  LayeredCholesky indefinite({ 1, 1 }, { 1, 1 });
  indefinite.panel(0) << 1, 2;
  indefinite.panel(1) << 1;
  EXPECT_FALSE(indefinite.factor());
}

TEST(Bodies, SegmentIsSofterThanTheRingWhereCutFreeAndStifferWhereClamped)
{
  using enum BodyModel::Kind;
  const BodyElements elements(make_gear_pair(twelve_tooth_pair(20)).pinion, coarse(2));
  const auto mean = [&](const BodyModel::Kind kind, const bool clamped) {
    return flank_compliance(elements, body_model(kind, clamped, BodyModel::Reduction::condensed, true), 1)
        .by_tooth_offset[0]
        .mean();
  };
  EXPECT_GT(mean(segment, false), mean(ring, false));
  EXPECT_LT(mean(segment, true), mean(ring, false));
}

TEST(Bodies, YieldLessTheDeeperBelowTheFlankTheyAreAskedFor)
{
  const BodyElements elements(make_gear_pair(twelve_tooth_pair(20)).pinion, coarse(2));
  const FlankCompliance c = flank_compliance(
      elements, body_model(BodyModel::Kind::ring, false, BodyModel::Reduction::condensed, true), 1, 3);
  ASSERT_EQ(c.by_depth.size(), 4u);
  for (std::size_t d = 1; d < c.by_depth.size(); ++d)
    {
      EXPECT_LT(c.by_depth[d].diagonal().sum(), 0.95 * c.by_depth[d - 1].diagonal().sum()) << d;
      EXPECT_GT((c.depth_positions[d] - c.depth_positions[d - 1]).colwise().norm().minCoeff(), 0.1)
          << d; // mm
    }
}

TEST(Bodies, HalfOfASpurBodyStandsForBoth)
{
  using enum BodyModel::Kind;
  const Gear gear = make_gear_pair(twelve_tooth_pair(0)).pinion;
  for (const int degree : { 1, 2, 3 })
    for (const BodyModel::Kind kind : { ring, segment })
      for (const int depth : { 0, 1 })
        {
          const BodyElements elements(gear, coarse(degree, 4));
          ASSERT_TRUE(has_mid_plane(gear, coarse(degree, 4)));
          EXPECT_LT(
              difference(
                  flank_compliance(elements, body_model(kind, false, BodyModel::Reduction::condensed, true),
                                   3, depth),
                  flank_compliance(elements, body_model(kind, false, BodyModel::Reduction::condensed, false),
                                   3, depth)),
              1e-9); // rounding of two factorisations
        }
  EXPECT_FALSE(has_mid_plane(gear, coarse(2, 3)));
  EXPECT_FALSE(has_mid_plane(make_gear_pair(twelve_tooth_pair(20)).pinion, coarse(2, 4)));
}

TEST(ToothSector, FlankNodesLieOnTheHelicoid)
{
  const Gear gear = make_gear_pair(paper_pair(25.232)).pinion;
  SectorResolution size;
  for (const int degree : { 1, 2, 3 })
    {
      size.degree = degree;
      const ToothSector sector = make_tooth_sector(gear, size);
      const auto body_owner =
          make_elastic_body(sector.mesh, degree, gear.youngs_modulus, gear.poissons_ratio);
      const ElasticBody &body = *body_owner;
      const auto surface = flank_surface(sector);
      const auto nodes = flank_nodes(sector, surface, body);
      for (int k = 0; k < surface.n_layer_nodes(); ++k)
        for (int i = 0; i < surface.n_row_nodes(); ++i)
          EXPECT_LT((body.node_positions()[nodes[surface.node(i, k)]] -
                     gear.flank().frame(std::sqrt(surface.q_at(i)), surface.z_at(k)).origin)
                        .norm(),
                    1e-11);
      EXPECT_GT(body.least_scaled_jacobian(), 0.3);
    }
}

TEST(FlankBlock, RigidTranslationOfTheCutMovesTheFlankWithIt)
{
  const Gear gear = make_gear_pair(paper_pair(25.232)).pinion;
  SectorResolution size;
  const ToothSector sector = make_tooth_sector(gear, size);
  const auto body_owner =
      make_elastic_body(sector.mesh, size.degree, gear.youngs_modulus, gear.poissons_ratio);
  const ElasticBody &body = *body_owner;
  const FlankBlocks blocks(sector, body);
  const auto normals = flank_normals(sector, flank_surface(sector));
  const auto surface = flank_surface(sector);
  const Eigen::Vector3d translation(0.3, -1.1, 0.7);
  for (const auto &[row, layer] : { std::pair{ 4, 5 }, { 0, 0 }, { 8, 9 }, { 1, 4 } })
    {
      const int shift = layer_shift(surface, layer, layer);
      const FlankBlock block = blocks.around(row, row, layer + shift, layer + shift);
      const Eigen::VectorXd moved = block.cut_response * translation.replicate(block.cut_positions.cols(), 1);
      for (int k = 0; k < block.layers_of_nodes; ++k)
        for (int i = 0; i < block.rows_of_nodes; ++i)
          EXPECT_NEAR(
              moved[block.node(i, k)],
              normals.col(surface.node(block.first_row * 2 + i, block.first_layer * 2 + k)).dot(translation),
              1e-9); // condition of a block of 1400 unknowns
      EXPECT_LT((block.load_response - block.load_response.transpose()).cwiseAbs().maxCoeff(),
                1e-10 * block.load_response.cwiseAbs().maxCoeff());
    }
}
