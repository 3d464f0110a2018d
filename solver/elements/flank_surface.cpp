// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/flank_surface.hpp"

#include "mesh/gear/tip_edge.hpp"

namespace flank
{
  double FlankSurface::q_at(const int row_node) const
  {
    const int row = std::min(row_node / degree, rows - 1);
    return q_of_row(row + abscissas[row_node - row * degree]);
  }

  double FlankSurface::z_at(const int layer_node) const
  {
    const int layer = std::min(layer_node / degree, layers - 1);
    return z_of_layer(layer + abscissas[layer_node - layer * degree]);
  }

  FlankSurface flank_surface(const ToothSector &sector)
  {
    const Gear &gear = sector.gear;
    return { .degree = sector.resolution.degree,
             .rows = sector.resolution.flank_rows,
             .layers = sector.resolution.face_layers,
             .q_tip = std::pow(body_tip_roll(gear), 2),
             .q_form = gear.form_roll * gear.form_roll,
             .face_width = gear.face_width,
             .abscissas = lobatto_abscissas(sector.resolution.degree) };
  }

  Eigen::Matrix3Xd flank_normals(const ToothSector &sector, const FlankSurface &surface)
  {
    const InvoluteHelicoid helicoid = sector.gear.flank();
    Eigen::Matrix3Xd normals(3, surface.n_nodes());
    for (int k = 0; k < surface.n_layer_nodes(); ++k)
      for (int i = 0; i < surface.n_row_nodes(); ++i)
        normals.col(surface.node(i, k)) =
            helicoid.frame(std::sqrt(std::max(0.0, surface.q_at(i))), surface.z_at(k)).inward;
    return normals;
  }

  std::vector<int> flank_nodes(const ToothSector &sector, const FlankSurface &surface,
                               const ElasticBody &body, const int depth, const int tooth)
  {
    const int p = surface.degree, n = p + 1, column = std::min(depth / p, sector.section.tooth_columns() - 1),
              across = depth - column * p;
    const int first = tooth * static_cast<int>(sector.mesh.cells.size());
    std::vector<int> nodes(surface.n_nodes(), -1);
    for (int layer = 0; layer < surface.layers; ++layer)
      for (int row = 0; row < surface.rows; ++row)
        {
          const auto &cell = body.cell_nodes(first + sector.tooth_cell(row, column, layer));
          for (int k = 0; k < n; ++k)
            for (int i = 0; i < n; ++i)
              nodes[surface.node(row * p + i, layer * p + k)] = cell[(k * n + across) * n + i];
        }
    return nodes;
  }

  std::vector<int> cut_nodes(const ToothSector &sector, const ElasticBody &body, const bool plus_side,
                             const int tooth)
  {
    const int p = body.degree(), n = p + 1, levels = sector.section.rim_layers(),
              layers = sector.resolution.face_layers;
    const int first = tooth * static_cast<int>(sector.mesh.cells.size()),
              column = plus_side ? 0 : sector.section.rim_columns() - 1, across = plus_side ? 0 : p;
    std::vector<int> nodes(static_cast<std::size_t>(levels * p) * (layers * p + 1), -1);
    for (int layer = 0; layer < layers; ++layer)
      for (int level = 0; level < levels; ++level)
        {
          const auto &cell = body.cell_nodes(first + sector.rim_cell(column, level, layer));
          for (int k = 0; k < n; ++k)
            for (int i = 0; i < n; ++i)
              if (level * p + i < levels * p)
                nodes[(layer * p + k) * levels * p + level * p + i] = cell[(k * n + across) * n + i];
        }
    return nodes;
  }

  std::vector<char> bore_unknowns(const ToothSector &sector, const ElasticBody &body, const int teeth)
  {
    std::vector<char> fixed(body.n_unknowns(), 0);
    const int p = body.degree(), n = p + 1;
    for (int tooth = 0; tooth < teeth; ++tooth)
      for (int layer = 0; layer < sector.resolution.face_layers; ++layer)
        for (int column = 0; column < sector.section.rim_columns(); ++column)
          {
            const auto &cell =
                body.cell_nodes(tooth * static_cast<int>(sector.mesh.cells.size()) +
                                sector.rim_cell(column, sector.section.rim_layers() - 1, layer));
            for (int k = 0; k < n; ++k)
              for (int j = 0; j < n; ++j)
                for (int c = 0; c < 3; ++c)
                  fixed[3 * cell[(k * n + j) * n + p] + c] = 1;
          }
    return fixed;
  }
} // namespace flank
