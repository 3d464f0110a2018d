// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/flank_block.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/linear/layered_cholesky.hpp"

namespace flank
{
  namespace
  {
    constexpr int rings = 2,
                  block_depth = 3; // one ring leaves up to 0.35 %, three rings change less than 0.04 %
  }

  FlankBlocks::FlankBlocks(const ToothSector &sector, const ElasticBody &body)
      : sector_(sector)
      , body_(body)
      , surface_(flank_surface(sector))
      , depth_(std::min(block_depth, sector.section.tooth_columns()))
  {
    normals_ = flank_normals(sector, surface_);
    const int rows = sector.section.tooth_rows();
    stiffness_.resize(static_cast<std::size_t>(rows) * depth_ * surface_.layers);
    parallel_for(surface_.layers, [&](const int layer) {
      for (int row = 0; row < rows; ++row)
        for (int c = 0; c < depth_; ++c)
          stiffness_[(layer * rows + row) * depth_ + c] =
              body.cell_stiffness(sector.tooth_cell(row, c, layer));
    });
  }

  int layer_shift(const FlankSurface &surface, const int first_layer, const int last_layer)
  {
    return first_layer > rings && last_layer < surface.layers - 1 - rings ? rings + 1 - first_layer : 0;
  }

  FlankBlock FlankBlocks::around(const int first_row, const int last_row, const int first_layer,
                                 const int last_layer) const
  {
    const int p = surface_.degree, n = p + 1, tooth_rows = sector_.section.tooth_rows();
    FlankBlock block;
    block.first_row = std::max(0, first_row - rings);
    block.last_row = std::min(tooth_rows - 1, last_row + rings);
    block.first_layer = std::max(0, first_layer - rings);
    block.last_layer = std::min(surface_.layers - 1, last_layer + rings);
    const int n_rows = block.last_row - block.first_row + 1,
              n_layers = block.last_layer - block.first_layer + 1;
    const int ni = n_rows * p + 1, nj = depth_ * p + 1, nk = n_layers * p + 1;
    const int flank_row_end =
        surface_.n_row_nodes() - 1 - block.first_row * p; // last local row node on the involute
    block.rows_of_nodes = std::min(ni, flank_row_end + 1);
    block.layers_of_nodes = nk;

    const bool tip_free = block.first_row == 0, low_free = block.first_layer == 0,
               high_free = block.last_layer == surface_.layers - 1;
    const bool opposite_free = depth_ == sector_.section.tooth_columns();
    const auto id = [&](const int i, const int j, const int k) { return (k * nj + j) * ni + i; };

    std::vector<int> free_index(static_cast<std::size_t>(ni) * nj * nk, -1), cut_index(free_index.size(), -1);
    std::vector<Eigen::Vector3d> position(free_index.size());
    for (int layer = 0; layer < n_layers; ++layer)
      for (int c = 0; c < depth_; ++c)
        for (int row = 0; row < n_rows; ++row)
          {
            const auto &nodes =
                body_.cell_nodes(sector_.tooth_cell(block.first_row + row, c, block.first_layer + layer));
            for (int k = 0; k < n; ++k)
              for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i)
                  position[id(row * p + i, c * p + j, layer * p + k)] =
                      body_.node_positions()[nodes[(k * n + j) * n + i]];
          }
    int n_free = 0, n_cut = 0;
    std::vector<int> last_coupled; // of nodes, that one shares elements with
    std::vector<Eigen::Index> layer_size;
    for (int k = 0; k < nk; ++k)
      {
        const int before = n_free;
        for (int j = 0; j < nj; ++j)
          for (int i = 0; i < ni; ++i)
            {
              const bool cut = (i == 0 && !tip_free) || i == ni - 1 || (j == nj - 1 && !opposite_free) ||
                               (k == 0 && !low_free) || (k == nk - 1 && !high_free);
              (cut ? cut_index : free_index)[id(i, j, k)] = cut ? n_cut++ : n_free++;
            }
        layer_size.push_back(3 * (n_free - before));
        last_coupled.push_back(std::min(nk - 1, (k / p + 1) * p));
      }
    block.cut_positions.resize(3, n_cut);
    for (std::size_t v = 0; v < position.size(); ++v)
      if (cut_index[v] >= 0)
        block.cut_positions.col(cut_index[v]) = position[v];

    LayeredCholesky factor(layer_size, last_coupled);
    Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(3 * n_free, 3 * n_cut);
    std::vector<int> local(n * n * n);
    for (int layer = 0; layer < n_layers; ++layer)
      for (int c = 0; c < depth_; ++c)
        for (int row = 0; row < n_rows; ++row)
          {
            const auto &ke =
                stiffness_[((block.first_layer + layer) * tooth_rows + block.first_row + row) * depth_ + c];
            for (int k = 0; k < n; ++k)
              for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i)
                  local[(k * n + j) * n + i] = id(row * p + i, c * p + j, layer * p + k);
            for (std::size_t b = 0; b < local.size(); ++b)
              {
                const int layer_b = local[b] / (ni * nj), free_b = 3 * free_index[local[b]],
                          cut_b = 3 * cut_index[local[b]];
                const Eigen::Index begin = factor.begin(layer_b);
                for (std::size_t a = 0; a < local.size(); ++a)
                  if (const int free_a = 3 * free_index[local[a]]; free_a >= 0)
                    {
                      if (free_b < 0)
                        coupling.block<3, 3>(free_a, cut_b) += ke.block<3, 3>(3 * a, 3 * b);
                      else if (free_a >= free_b)
                        factor.panel(layer_b).block<3, 3>(free_a - begin, free_b - begin) +=
                            ke.block<3, 3>(3 * a, 3 * b);
                    }
              }
          }

    // Unit normal forces on the flank nodes, and by symmetry the functional that reads the normal
    // displacement.
    const int n_flank = block.rows_of_nodes * block.layers_of_nodes;
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * n_free, n_flank);
    const auto normal = [&](const int i, const int k) {
      return normals_.col(surface_.node(block.first_row * p + i, block.first_layer * p + k));
    };
    for (int k = 0; k < block.layers_of_nodes; ++k)
      for (int i = 0; i < block.rows_of_nodes; ++i)
        if (const int f = free_index[id(i, 0, k)]; f >= 0)
          unit.block<3, 1>(3 * f, block.node(i, k)) = normal(i, k);
    const bool positive = factor.factor();
    FLANK_ASSERT(positive, "block stiffness is positive definite");
    Eigen::MatrixXd response = unit;
    factor.solve_in_place(response);
    block.load_response = unit.transpose() * response;
    block.cut_response = -response.transpose() * coupling;
    for (int k = 0; k < block.layers_of_nodes; ++k)
      for (int i = 0; i < block.rows_of_nodes; ++i)
        if (const int c = cut_index[id(i, 0, k)]; c >= 0)
          block.cut_response.block<1, 3>(block.node(i, k), 3 * c) = normal(i, k).transpose();

    // True free faces, element by element, with their nodes' forces.
    std::vector<int> face_index(position.size(), -1);
    std::vector<int> face_nodes;
    const auto add_face = [&](const int axis, const bool high, const int e1, const int e2) {
      FlankBlock::Face face;
      // Axes (first, second) of the face in cyclic order after `axis`, so that d1 x d2 points along +axis.
      const std::array<int, 3> size{ ni, nj, nk };
      const int first = (axis + 1) % 3, second = (axis + 2) % 3;
      for (int b = 0; b < n; ++b)
        for (int a = 0; a < n; ++a)
          {
            std::array<int, 3> ijk{};
            ijk[axis] = high ? size[axis] - 1 : 0;
            ijk[first] = e1 * p + a;
            ijk[second] = e2 * p + b;
            const int v = id(ijk[0], ijk[1], ijk[2]);
            if (free_index[v] >= 0 && face_index[v] < 0)
              {
                face_index[v] = static_cast<int>(face_nodes.size());
                face_nodes.push_back(v);
              }
            face.nodes.push_back(face_index[v]);
            face.positions.push_back(position[v]);
          }
      face.outward = high ? 1 : -1;
      block.faces.push_back(std::move(face));
    };
    const std::array<int, 3> elements{ n_rows, depth_, n_layers };
    const auto add_side = [&](const int axis, const bool high) {
      for (int e2 = 0; e2 < elements[(axis + 2) % 3]; ++e2)
        for (int e1 = 0; e1 < elements[(axis + 1) % 3]; ++e1)
          add_face(axis, high, e1, e2);
    };
    if (tip_free)
      add_side(0, false);
    if (opposite_free)
      add_side(1, true);
    if (low_free)
      add_side(2, false);
    if (high_free)
      add_side(2, true);
    block.face_response.resize(n_flank, 3 * face_nodes.size());
    for (std::size_t v = 0; v < face_nodes.size(); ++v)
      block.face_response.middleCols<3>(3 * v) =
          response.middleRows<3>(3 * free_index[face_nodes[v]]).transpose();
    return block;
  }
} // namespace flank
