// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "tests/example_pairs.hpp"

// Draft bodies of the helical example and of its spur sister: the identities tested with them hold for any
// mesh.

inline flank::SectorResolution small_sector()
{
  flank::SectorResolution size;
  size.flank_rows = 6, size.tooth_columns = 4, size.face_layers = 6, size.rim_layers = 5;
  return size;
}

constexpr flank::ContactGridSize small_grid{ 15, 11 };

/// helix_angle: 0, or anything else for 25.232 deg.
inline const flank::BodyCompliance &small_body(const double helix_angle)
{
  const auto make = [](const double degrees) {
    return flank::BodyCompliance(flank::make_gear_pair(paper_pair(degrees)).pinion, small_sector(), 6);
  };
  if (helix_angle == 0)
    {
      static const flank::BodyCompliance spur = make(0);
      return spur;
    }
  static const flank::BodyCompliance helical = make(25.232);
  return helical;
}

/// A loaded pair of these bodies on rigid mountings; derivatives, kept cells and sub-surface stress are off.
inline flank::LoadedPair small_loaded_pair(const flank::GearPair &pair, const flank::BodyCompliance &pinion,
                                           const flank::BodyCompliance &gear,
                                           const flank::MeshDeviations &deviations = {},
                                           const flank::ContactGridSize &grid = small_grid)
{
  return { .bodies = { .pair = pair,
                       .pinion = pinion,
                       .gear = gear,
                       .grid = grid,
                       .pinion_mounting = {},
                       .gear_mounting = {} },
           .deviations = deviations };
}

inline double te(const flank::GearPair &pair, const flank::PositionResult &result)
{
  return flank::transmission_error_um(pair, result);
}

/// Symmetric compliance of a body for patches that stand slice by slice, as a grid's do. seen: the patches
/// that the half-space's distances are taken of, on that flank.
inline Eigen::MatrixXd compliance_of(const flank::BodyCompliance &body,
                                     const std::vector<flank::Patch> &patches,
                                     const std::vector<flank::Patch> &seen,
                                     const flank::InvoluteHelicoid &flank)
{
  std::vector<flank::PatchGroup> groups;
  std::vector<std::vector<flank::Patch>> seen_groups;
  std::vector<Eigen::Index> first;
  for (std::size_t i = 0; i < patches.size();)
    {
      std::size_t end = i;
      while (end < patches.size() && patches[end].tooth == patches[i].tooth &&
             std::abs(patches[end].z - patches[i].z) < patches[i].half_generator)
        ++end;
      const auto part = [&](const std::vector<flank::Patch> &all) {
        return std::vector<flank::Patch>(all.begin() + i, all.begin() + end);
      };
      groups.push_back(body.group(part(patches)));
      seen_groups.push_back(part(seen));
      first.push_back(static_cast<Eigen::Index>(i));
      i = end;
    }
  const auto n = static_cast<Eigen::Index>(patches.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t a = 0; a < groups.size(); ++a)
    for (std::size_t b = 0; b < groups.size(); ++b)
      {
        const auto rows = static_cast<Eigen::Index>(groups[a].patches.size()),
                   columns = static_cast<Eigen::Index>(groups[b].patches.size());
        Eigen::MatrixXd far = Eigen::MatrixXd::Zero(columns, rows);
        body.add_far(groups[b], { &groups[a] }, { &far });
        Eigen::MatrixXd block = far.transpose();
        if (body.is_near(groups[a], groups[b]))
          { // Both ways from one set, as a grid has them.
            const Eigen::MatrixXd potential =
                flank::patch_potentials(seen_groups[std::min(a, b)], seen_groups[std::max(a, b)], flank);
            body.add_near(groups[a], groups[b], a <= b ? potential : Eigen::MatrixXd(potential.transpose()),
                          block, nullptr);
          }
        c.block(first[a], first[b], block.rows(), block.cols()) = block;
      }
  return 0.5 * (c + c.transpose());
}
