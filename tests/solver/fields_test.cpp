// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/gauss.hpp"
#include "solver/fields/loaded_teeth.hpp"
#include "solver/linear/direct_solver.hpp"
#include "solver/reduction/flank_compliance.hpp"
#include "tests/example_pairs.hpp"
#include "tests/solver/displacements.hpp"

#include <gtest/gtest.h>

#include <numeric>

using namespace flank;

namespace
{
  SectorResolution coarse()
  {
    SectorResolution r;
    r.flank_rows = 4, r.tooth_columns = 4, r.face_layers = 3, r.fillet_rows = 1, r.fillet_columns = 1,
    r.rim_layers = 3;
    return r;
  }

  /// Some load on two neighbouring teeth. [N]
  TeethLoads two_teeth(const int n_flank)
  {
    TeethLoads loads{ { 0, Eigen::VectorXd::Zero(n_flank) }, { 1, Eigen::VectorXd::Zero(n_flank) } };
    for (int i = 0; i < n_flank; ++i)
      {
        loads[0][i] = 10 + 3 * std::sin(i);
        loads[1][i] = i % 5;
      }
    return loads;
  }

  class LoadedBody : public testing::TestWithParam<BodyModel>
  {
  };
} // namespace

// The fields' own way through the body, inside and all, must end at the displacements that the contact was
// solved with: the work of one tooth's forces on the displacements that another's make, both ways, as a
// segment's operator is the mean of both directions.
TEST_P(LoadedBody, FlanksMoveAsTheOperatorSays)
{
  const Gear gear = make_gear_pair(twelve_tooth_pair(20)).pinion;
  const BodyElements elements(gear, coarse());
  const FlankSurface surface = flank_surface(elements.sector());
  const TeethLoads both = two_teeth(surface.n_nodes());
  const FlankCompliance far = flank_compliance(elements, GetParam(), 2);
  const LoadedTeeth body(elements, GetParam());
  const auto nodes = flank_nodes(elements.sector(), surface, elements.body());
  const auto normals = flank_normals(elements.sector(), surface);
  const auto work = [&](const Eigen::VectorXd &force, const Eigen::VectorXd &displacement) {
    double sum = 0;
    for (int i = 0; i < surface.n_nodes(); ++i)
      sum += force[i] * normals.col(i).dot(displacement.segment<3>(3 * nodes[i]));
    return sum;
  };
  const Eigen::VectorXd &f = both.at(0), &g = both.at(1);
  for (int offset = 0; offset <= 2; ++offset)
    {
      const auto of_f = displacements(body, { { 3, f } }, { 3, 3 + offset }),
                 of_g = displacements(body, { { 3 + offset, g } }, { 3 });
      const double expected = 2 * g.dot(far.by_tooth_offset[offset] * f);
      EXPECT_NEAR(work(g, of_f[1]) + work(f, of_g[0]), expected, 1e-10 * std::abs(expected)) << offset;
      EXPECT_EQ(displacements(body, {}, { 3 })[0].norm(), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(, LoadedBody,
                         testing::Values(BodyModel{}, BodyModel{ BodyModel::Kind::segment, 5, false },
                                         BodyModel{ BodyModel::Kind::segment, 5, true }));

// A plain finite-element solution of the whole gear under the same forces, sharing nothing but the elements.
TEST(BodyStress, EqualsAPlainSolutionOfTheWholeGear)
{
  const Gear gear = make_gear_pair(twelve_tooth_pair(20)).pinion;
  const BodyElements elements(gear, coarse());
  const auto &sector = elements.sector();
  const auto surface = flank_surface(sector);
  const TeethLoads loads = two_teeth(surface.n_nodes());
  const auto turned = [&](const int tooth) {
    return Eigen::AngleAxisd(tooth * gear.pitch_angle(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  };

  const auto whole_owner = make_elastic_body(joined_sectors(sector, gear.teeth), sector.resolution.degree,
                                             gear.youngs_modulus, gear.poissons_ratio);
  const ElasticBody &whole = *whole_owner;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(whole.n_unknowns());
  for (const auto &[tooth, load] : loads)
    {
      const auto nodes = flank_nodes(sector, surface, whole, 0, tooth);
      const Eigen::Matrix3Xd normals = turned(tooth) * flank_normals(sector, surface);
      for (int i = 0; i < surface.n_nodes(); ++i)
        force.segment<3>(3 * nodes[i]) += load[i] * normals.col(i);
    }
  const Eigen::VectorXd directly =
      make_direct_solver(whole.stiffness(), bore_unknowns(sector, whole, gear.teeth))->solve(force);
  const auto moved = displacements(LoadedTeeth(elements, BodyModel{}), loads, { 0, 1, 2, -1 });
  const auto points = std::vector<Eigen::Vector3d>{ { 0.2, 0.3, 0.5 }, { 1, 1, 0 } };
  double greatest = 0, difference = 0;
  for (int t = 0; t < 4; ++t)
    {
      const int tooth = t == 3 ? -1 : t,
                first = (t == 3 ? gear.teeth - 1 : t) * static_cast<int>(sector.mesh.cells.size());
      const Eigen::Matrix3d back = turned(tooth).transpose();
      for (int cell = 0; cell < static_cast<int>(sector.mesh.cells.size()); ++cell)
        {
          std::vector<Eigen::Matrix3d> plain;
          whole.each_sample({ first + cell }, points, directly, [&](int, const ElasticBody::Samples &s) {
            for (Eigen::Index q = 0; q < s.stress.cols(); ++q)
              plain.push_back(back * stress_tensor(s.stress.col(q)) * back.transpose());
          });
          elements.body().each_sample({ cell }, points, moved[t], [&](int, const ElasticBody::Samples &s) {
            for (Eigen::Index q = 0; q < s.stress.cols(); ++q)
              {
                greatest = std::max(greatest, plain[q].cwiseAbs().maxCoeff());
                difference =
                    std::max(difference, (stress_tensor(s.stress.col(q)) - plain[q]).cwiseAbs().maxCoeff());
              }
          });
        }
    }
  EXPECT_GT(greatest, 1);
  EXPECT_LT(difference, 1e-8 * greatest); // rounding of two ways through the same equations
}

TEST(BodyStress, AtTheBoreCarriesTheAppliedTorque)
{
  const Gear gear = make_gear_pair(twelve_tooth_pair(20)).pinion;
  SectorResolution fine = coarse();
  fine.rim_layers = 12, fine.fillet_columns = 2, fine.root_land_columns = 2;
  const BodyElements elements(gear, fine);
  const auto &sector = elements.sector();
  const auto surface = flank_surface(sector);
  const auto normals = flank_normals(sector, surface);
  const auto nodes = flank_nodes(sector, surface, elements.body());
  const TeethLoads loads = two_teeth(surface.n_nodes());
  double applied = 0, carried = 0;
  for (const auto &[tooth, force] : loads)
    for (int i = 0; i < surface.n_nodes(); ++i)
      applied +=
          force[i] * elements.body().node_positions()[nodes[i]].cross(Eigen::Vector3d(normals.col(i))).z();

  std::vector<int> all(gear.teeth);
  std::iota(all.begin(), all.end(), 0);
  const auto moved = displacements(LoadedTeeth(elements, BodyModel{}), loads, all);
  const GaussRule &rule = gauss(4);
  std::vector<Eigen::Vector3d> points{ { 1, 0, 0 }, { 1, 1, 1 } };
  for (const double z : rule.point)
    for (const double across : rule.point)
      points.emplace_back(1, across, z);
  std::vector<int> at_bore;
  for (int column = 0; column < sector.section.rim_columns(); ++column)
    for (int layer = 0; layer < sector.resolution.face_layers; ++layer)
      at_bore.push_back(sector.rim_cell(column, sector.section.rim_layers() - 1, layer));
  for (const auto &displacement : moved)
    elements.body().each_sample(at_bore, points, displacement, [&](int, const ElasticBody::Samples &s) {
      const double twist = gear.flank().twist() * (s.position(2, 1) - s.position(2, 0));
      const double angle = std::abs(std::atan2(s.position(1, 1), s.position(0, 1)) -
                                    std::atan2(s.position(1, 0), s.position(0, 0)) - twist),
                   height = s.position(2, 1) - s.position(2, 0);
      for (std::size_t v = 0; v < rule.point.size(); ++v)
        for (std::size_t u = 0; u < rule.point.size(); ++u)
          {
            const auto q = static_cast<Eigen::Index>(2 + v * rule.point.size() + u);
            const Eigen::Vector3d radial =
                                      Eigen::Vector3d(s.position(0, q), s.position(1, q), 0).normalized(),
                                  around = Eigen::Vector3d::UnitZ().cross(radial);
            const Eigen::Matrix3d stress = stress_tensor(s.stress.col(q));
            carried += rule.weight[u] * rule.weight[v] * angle * height * std::pow(gear.bore_radius, 2) *
                       around.dot(stress * radial);
          }
    });
  EXPECT_NEAR(carried / applied, 1,
              0.005); // the stress of elements meets the clamped face nearly: 0.6 % with 8 layers of the rim
}
