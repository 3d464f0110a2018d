// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/fields/fillet_stress.hpp"

#include "solver/fields/loaded_teeth.hpp"
#include "tests/example_pairs.hpp"
#include "tests/solver/displacements.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

using namespace flank;

namespace
{
  SectorResolution small_sector()
  {
    SectorResolution size;
    size.flank_rows = 6, size.tooth_columns = 4, size.face_layers = 6, size.rim_layers = 7;
    return size;
  }

  /// A force spread evenly along the face over one row of the flank's nodes, of degree 2, inward [N]:
  /// Simpson's rule.
  Eigen::VectorXd row_force(const FlankSurface &surface, const int row, const double total)
  {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(surface.n_nodes());
    for (int k = 0; k < surface.n_layer_nodes(); ++k)
      force[surface.node(row, k)] = (k == 0 || k == surface.n_layer_nodes() - 1 ? 1
                                     : k % 2                                    ? 4
                                                                                : 2) *
                                    total / (6 * surface.layers);
    return force;
  }
} // namespace

// The band's surface is the tooth's: the fillet's arc from where the flank ends to the root circle, then the
// root circle; inwards it is normal to both; the other side is its mirror image.
TEST(FilletStress, BandsLieOnTheToothsSurface)
{
  const Gear gear = make_gear_pair(paper_pair(0)).pinion;
  const BodyElements elements(gear, small_sector());
  const ToothProfile profile(gear);
  const FilletBlock band(elements.sector(), 0), other(elements.sector(), 1);
  const auto [first, last] = band.on_fillet();
  EXPECT_LT((band.section_point(first, 0, 0) - profile.fillet_point(0)).norm(), 1e-12); // rounding of 70 mm
  EXPECT_LT((band.section_point(last, 1, 0) - profile.fillet_point(1)).norm(), 1e-12);
  EXPECT_NEAR(profile.fillet_point(0).norm(), gear.form_radius, 1e-9);
  EXPECT_NEAR(profile.fillet_point(1).norm(), gear.root_radius, 1e-9);
  double depth = 0;
  for (int a = 0; a < band.along(); ++a)
    for (const double along : { 0.0, 0.3, 1.0 })
      {
        const Eigen::Vector2d surface = band.section_point(a, along, 0),
                              deep = band.section_point(band.cell(a, band.deep() - 1, 0), along, 1);
        const bool on_fillet = a >= first && a <= last;
        const Eigen::Vector2d from = on_fillet ? profile.fillet_centre() : Eigen::Vector2d::Zero();
        EXPECT_NEAR((surface - from).norm(), on_fillet ? gear.fillet_radius : gear.root_radius, 1e-12);
        depth = std::abs((deep - from).norm() - (surface - from).norm());
        EXPECT_NEAR(depth, (deep - surface).norm(), 1e-12);
        EXPECT_GT(depth, gear.fillet_radius);
        const Eigen::Vector2d mirrored = other.section_point(band.along() - 1 - a, 1 - along, 0);
        EXPECT_LT((mirrored - Eigen::Vector2d(surface.x(), -surface.y())).norm(), 1e-12);
      }
}

// Pulled along its face a spur tooth is under one and the same stress everywhere, and all faces but its ends
// are free of load: in the middle of the face every fillet must say it.
TEST(FilletStress, FilletsOfASectorStretchedAlongItsFace)
{
  const Gear gear = make_gear_pair(paper_pair(0)).pinion;
  for (const int degree : { 1, 2 })
    {
      SectorResolution size = small_sector();
      size.degree = degree;
      const BodyElements elements(gear, size);
      const ElasticBody &body = elements.body();
      const Eigen::Vector3d strain(-gear.poissons_ratio * 1e-3, -gear.poissons_ratio * 1e-3, 1e-3);
      Eigen::VectorXd displacement(body.n_unknowns());
      for (int node = 0; node < body.n_nodes(); ++node)
        displacement.segment<3>(3 * node) = strain.cwiseProduct(body.node_positions()[node]);
      const FlankSurface surface = flank_surface(elements.sector());
      const auto stress = FilletStress(elements).greatest(displacement);
      for (const auto &side : stress)
        {
          ASSERT_EQ(side.size(), static_cast<std::size_t>(surface.n_layer_nodes()));
          // The free ends are three of the band's depths away.
          EXPECT_NEAR(side[side.size() / 2], 1e-3 * gear.youngs_modulus, 2e-3 * 1e-3 * gear.youngs_modulus);
        }
    }
}

// Elements of half the size everywhere, those of the sector and so those that hold the band, change the
// stress little; turned as a rigid body the tooth has none.
TEST(FilletStress, FilletsHardlyDependOnTheSectorsElements)
{
  const Gear gear = make_gear_pair(paper_pair(25.232)).pinion;
  std::array<double, 2> found{};
  for (const int finer : { 0, 1 })
    {
      SectorResolution size = small_sector();
      if (finer)
        size.flank_rows *= 2, size.tooth_columns *= 2, size.fillet_rows = 4, size.fillet_columns = 4,
                                                       size.rim_layers *= 2;
      const BodyElements elements(gear, size);
      const FlankSurface surface = flank_surface(elements.sector());
      const LoadedTeeth teeth(elements, BodyModel{});
      const FilletStress fillets(elements);
      const Eigen::VectorXd force = row_force(surface, surface.rows, 1000);
      const auto stress = fillets.greatest(displacements(teeth, { { 0, force } }, { 0 })[0]);
      found[finer] = stress[0][stress[0].size() / 2];
      Eigen::VectorXd turned(elements.body().n_unknowns());
      for (int node = 0; node < elements.body().n_nodes(); ++node)
        turned.segment<3>(3 * node) =
            1e-3 * Eigen::Vector3d(1, 2, 3).cross(elements.body().node_positions()[node]);
      for (const auto &side : fillets.greatest(turned))
        for (const double value : side)
          // Along z the sector's elements interpolate the helix: 75 mm by the cube of a layer's twist of 0.02
          // over 70, turned by 1e-3 within elements of 0.1 mm.
          EXPECT_LT(std::abs(value), 2e-4 * gear.youngs_modulus * 1e-3);
    }
  EXPECT_NEAR(found[0] / found[1], 1, 0.015);
  std::cout << "fillet stress " << found[0] << ", elements of half the size " << found[1] << "\n";
}

// Bending of a tooth as a beam: where the load moves up the tooth the root stress grows as its lever, and the
// other fillet is pressed.
TEST(FilletStress, RootStressFollowsTheLeverOfTheLoad)
{
  const Gear gear = make_gear_pair(paper_pair(0)).pinion;
  const BodyElements elements(gear, small_sector());
  const FlankSurface surface = flank_surface(elements.sector());
  const LoadedTeeth teeth(elements, BodyModel{});
  const FilletStress fillets(elements);
  std::vector<double> lever, tension;
  for (const int row : { 0, 2, 4 })
    {
      const Eigen::VectorXd force = row_force(surface, row, 1000);
      const auto stress = fillets.greatest(displacements(teeth, { { 0, force } }, { 0 })[0]);
      // The normal's line meets the tooth's centre line at r_b / cos(half angle + roll - ...): the lever is
      // its height over the root.
      const double roll = std::sqrt(surface.q_at(row)),
                   angle = roll - gear.half_angle_at_base; // of the force against the tooth's side
      lever.push_back((gear.base_radius / std::cos(angle) - gear.form_radius) * std::cos(angle));
      tension.push_back(stress[0][stress[0].size() / 2]);
      EXPECT_LT(stress[1][stress[1].size() / 2], 0.3 * tension.back());
    }
  EXPECT_GT(tension[0], tension[1]);
  EXPECT_GT(tension[1], tension[2]);
  // Radial pressure and the fillet's own height under the lever take some off: within a fifth of
  // proportional.
  EXPECT_NEAR((tension[0] / tension[2]) / (lever[0] / lever[2]), 1, 0.2);
}

// From the lowest places of the flank on the load goes on to the fillet without a jump.
TEST(FilletStress, RootStressOfForcesOnTheFootOfAFlankIsSmooth)
{
  const Gear gear = make_gear_pair(paper_pair(0)).pinion;
  SectorResolution size = small_sector();
  size.flank_rows = 16;
  const BodyElements elements(gear, size);
  const FlankSurface surface = flank_surface(elements.sector());
  const LoadedTeeth teeth(elements, BodyModel{});
  const FilletStress fillets(elements);
  std::vector<double> stress;
  for (int row = surface.n_row_nodes() - 6; row < surface.n_row_nodes() - 1; ++row)
    {
      const Eigen::VectorXd force = row_force(surface, row, 1000);
      const auto along_face = fillets.greatest(displacements(teeth, { { 0, force } }, { 0 })[0])[0];
      stress.push_back(along_face[along_face.size() / 2]);
    }
  for (std::size_t i = 1; i < stress.size(); ++i)
    EXPECT_NEAR(stress[i] / stress[i - 1], 1, 0.1) << i; // 0.2 mm apart, of a fillet radius of 1 mm
}
