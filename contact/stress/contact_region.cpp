// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/stress/contact_region.hpp"

#include "solver/elements/flank_block.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
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
              free_faces_.push_back({ own, 0, FlankEnd::none });
            if (!cuts_tooth && column == depth - 1)
              free_faces_.push_back({ own, 3, FlankEnd::none });
            if (layer == 0)
              free_faces_.push_back({ own, 4, FlankEnd::low });
            if (layer == layers - 1)
              free_faces_.push_back({ own, 5, FlankEnd::high });
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
                                                 const NearLoads &loads) const
  {
    const ToothSector &sector = elements_.sector();
    const FlankSurface surface = flank_surface(sector);
    const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(body_->n_unknowns()), held = force;
    for (Eigen::Index i = 0; i < normals.cols(); ++i)
      force.segment<3>(3 * flank_[i]) += flank_force[i] * normals.col(i);
    for (const auto &[cell, face, end] : free_faces_)
      body_->add_traction(
          cell, face,
          [&, end = end](const Eigen::Vector3d &x, const Eigen::Vector3d &outward) -> Eigen::Vector3d {
            return loads.stress_on(end, x) * outward;
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
