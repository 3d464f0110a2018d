// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/stress/contact_region.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/matching/patch_weights.hpp"
#include "solver/elements/flank_block.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  HalfSpaceLoads::HalfSpaceLoads(const Gear &gear, const FlankSurface &surface)
      : gear_(gear)
      , surface_(surface)
      , loaded_(static_cast<std::size_t>(surface.rows) * surface.layers, 0)
  {
  }

  void HalfSpaceLoads::add(const Patch &patch, const double force)
  {
    sources_.push_back({ TangentHalfSpace(gear_.flank().frame(patch.roll, patch.z)), patch.half_profile,
                         patch.half_generator, force });
    const PatchWeights weights(surface_, { patch });
    const PatchWeights::Extent &w = weights.extent(0);
    const auto element = [](const double at, const int count) {
      return std::clamp(static_cast<int>(std::floor(at)), 0, count - 1);
    };
    for (int layer = element(w.layer_low, surface_.layers); layer <= element(w.layer_high, surface_.layers);
         ++layer)
      for (int row = element(w.row_low, surface_.rows); row <= element(w.row_high, surface_.rows); ++row)
        loaded_[static_cast<std::size_t>(layer * surface_.rows + row)] = 1;
  }

  HalfSpaceLoads::Field HalfSpaceLoads::at(const Eigen::Vector3d &point) const
  {
    Field sum;
    for (const Source &s : sources_)
      {
        const Eigen::Vector3d x = TangentHalfSpace::inside(s.below.relative(point));
        const Eigen::Matrix3d &axes = s.below.axes();
        const double near = 6 * std::max(s.half_profile, s.half_generator);
        const bool close = x.squaredNorm() < near * near;
        sum.displacement +=
            axes *
            (s.force *
             (close ? half_space::love_displacement(s.half_profile, s.half_generator, x, gear_.youngs_modulus,
                                                    gear_.poissons_ratio)
                    : half_space::boussinesq_displacement(x, gear_.youngs_modulus, gear_.poissons_ratio)));
        const Eigen::Matrix3d stress =
            close ? half_space::love_stress(s.half_profile, s.half_generator, x, gear_.poissons_ratio)
                  : half_space::boussinesq_stress(x, gear_.poissons_ratio);
        sum.stress += axes * (s.force * stress) * axes.transpose();
      }
    return sum;
  }

  std::map<int, HalfSpaceLoads> half_space_loads(const Gear &gear, const FlankSurface &surface,
                                                 const PositionResult &result, const Side side)
  {
    std::map<int, HalfSpaceLoads> loads;
    each_loaded_patch(result, side, [&](const Patch &patch, const double force) {
      loads.try_emplace(patch.tooth, gear, surface).first->second.add(patch, force);
    });
    return loads;
  }

  ContactRegion::ContactRegion(const BodyElements &elements)
      : elements_(elements)
      , of_sector_cell_(elements.sector().mesh.cells.size(), -1)
  {
    const ToothSector &sector = elements.sector();
    const SectorResolution &size = sector.resolution;
    const int depth = block_depth_of(size.tooth_columns), rows = size.flank_rows, layers = size.face_layers;
    const bool cuts_tooth = depth < size.tooth_columns; // else the other flank is a free face of the region
    HexMesh mesh;
    std::vector<int> cells, vertex(sector.mesh.vertices.size(), -1);
    for (int layer = 0; layer < layers; ++layer)
      for (int column = 0; column < depth; ++column)
        for (int row = 0; row < rows; ++row)
          {
            const int cell = sector.tooth_cell(row, column, layer), own = static_cast<int>(cells.size());
            of_sector_cell_[cell] = own;
            cells.push_back(cell);
            std::array<int, 8> corners{};
            for (int i = 0; i < 8; ++i)
              {
                int &v = vertex[sector.mesh.cells[cell][i]];
                if (v < 0)
                  {
                    v = static_cast<int>(mesh.vertices.size());
                    mesh.vertices.push_back(sector.mesh.vertices[sector.mesh.cells[cell][i]]);
                  }
                corners[i] = v;
              }
            mesh.cells.push_back(corners);
            if (row == 0)
              free_faces_.emplace_back(own, 0);
            if (!cuts_tooth && column == depth - 1)
              free_faces_.emplace_back(own, 3);
            if (layer == 0)
              free_faces_.emplace_back(own, 4);
            if (layer == layers - 1)
              free_faces_.emplace_back(own, 5);
          }
    mesh.map = [&sector, cells](const int cell, const Eigen::Vector3d &x) {
      return sector.mesh.map(cells[cell], x);
    };
    body_ = make_elastic_body(mesh, size.degree, sector.gear.youngs_modulus, sector.gear.poissons_ratio);

    solver_ = make_direct_solver(body_->stiffness(), number_nodes(cells, rows, depth, cuts_tooth));
  }

  /// Nodes of the sector, of the flank and on the cut; returns the unknowns on the cut.
  std::vector<char> ContactRegion::number_nodes(const std::vector<int> &cells, const int rows,
                                                const int depth, const bool cuts_tooth)
  {
    const ToothSector &sector = elements_.sector();
    const int n = sector.resolution.degree + 1;
    std::vector<int> own_node(elements_.body().n_nodes(), -1);
    std::vector<char> fixed(body_->n_unknowns(), 0);
    sector_node_.resize(body_->n_nodes());
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        const auto &own = body_->cell_nodes(static_cast<int>(c)),
                   &whole = elements_.body().cell_nodes(cells[c]);
        const int row = static_cast<int>(c) % rows, column = static_cast<int>(c) / rows % depth;
        for (int k = 0; k < n; ++k)
          for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
              {
                const int node = own[(k * n + j) * n + i];
                sector_node_[node] = whole[(k * n + j) * n + i];
                own_node[sector_node_[node]] = node;
                if ((row == rows - 1 && i == n - 1) || (cuts_tooth && column == depth - 1 && j == n - 1))
                  std::fill_n(fixed.begin() + 3 * node, 3, 1);
              }
      }
    for (int node = 0; node < body_->n_nodes(); ++node)
      if (fixed[3 * node])
        cut_.push_back(node);
    for (const int node : flank_nodes(sector, flank_surface(sector), elements_.body()))
      flank_.push_back(own_node[node]);
    return fixed;
  }

  Eigen::VectorXd ContactRegion::without_contact(const Eigen::VectorXd &displacement,
                                                 const Eigen::VectorXd &flank_force,
                                                 const HalfSpaceLoads &loads) const
  {
    const ToothSector &sector = elements_.sector();
    const FlankSurface surface = flank_surface(sector);
    const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(body_->n_unknowns()), held = force;
    for (Eigen::Index i = 0; i < normals.cols(); ++i)
      force.segment<3>(3 * flank_[i]) += flank_force[i] * normals.col(i);
    for (const auto &[cell, face] : free_faces_)
      body_->add_traction(
          cell, face,
          [&](const Eigen::Vector3d &x, const Eigen::Vector3d &outward) -> Eigen::Vector3d {
            return loads.at(x).stress * outward;
          },
          force);
    for (const int node : cut_)
      held.segment<3>(3 * node) = loads.at(body_->node_positions()[node]).displacement;
    const Eigen::VectorXd of_elements = solver_->solve(force, held);
    Eigen::VectorXd result(force.size());
    for (std::size_t node = 0; node < sector_node_.size(); ++node)
      result.segment<3>(3 * node) =
          displacement.segment<3>(3 * sector_node_[node]) - of_elements.segment<3>(3 * node);
    return result;
  }
} // namespace flank
