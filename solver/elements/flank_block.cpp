// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/flank_block.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/linear/layered_cholesky.hpp"

#include <array>

namespace flank
{
  FlankBlocks::FlankBlocks(const ToothSector &sector, const ElasticBody &body)
      : sector_(sector)
      , body_(body)
      , surface_(flank_surface(sector))
      , depth_(block_depth_of(sector.section.tooth_columns()))
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
    return first_layer > block_rings && last_layer < surface.layers - 1 - block_rings
               ? block_rings + 1 - first_layer
               : 0;
  }

  /// Makes one block, step by step.
  class FlankBlocks::Builder
  {
  public:
    Builder(const FlankBlocks &blocks, const std::array<int, 4> &elements);

    FlankBlock build();

  private:
    int id(const int i, const int j, const int k) const { return (k * nj_ + j) * ni_ + i; }

    /// Nodes of the block's element (row, column, layer), in the element's order.
    std::vector<int> nodes_of(int row, int column, int layer) const;

    void place_nodes();
    void number_nodes();
    void assemble(LayeredCholesky &factor, Eigen::MatrixXd &coupling) const;
    Eigen::MatrixXd unit_forces() const;
    void read_cut_on_flank();
    void add_face(int axis, bool high, int first_element, int second_element);
    void add_free_faces();

    auto normal(const int row_node, const int layer_node) const
    {
      return all_.normals_.col(
          all_.surface_.node(block_.first_row * p_ + row_node, block_.first_layer * p_ + layer_node));
    }

    const FlankBlocks &all_;
    int p_, n_;             ///< degree, nodes along an element's edge
    int n_rows_, n_layers_; ///< elements
    int ni_, nj_, nk_;      ///< nodes along rows, into the depth, along layers
    bool tip_free_, low_free_, high_free_, opposite_free_;
    FlankBlock block_;

    std::vector<Eigen::Vector3d> position_;
    std::vector<int> free_index_, cut_index_; ///< of nodes; -1: it is the other
    int n_free_ = 0, n_cut_ = 0;
    std::vector<Eigen::Index> layer_size_; ///< unknowns of a layer of nodes
    std::vector<int> last_coupled_;        ///< layer of nodes that one shares elements with

    std::vector<int> face_index_, face_nodes_;
  };

  FlankBlocks::Builder::Builder(const FlankBlocks &blocks, const std::array<int, 4> &elements)
      : all_(blocks)
      , p_(blocks.surface_.degree)
      , n_(p_ + 1)
  {
    const auto &[first_row, last_row, first_layer, last_layer] = elements;
    const FlankSurface &surface = all_.surface_;
    block_.first_row = std::max(0, first_row - block_rings);
    block_.last_row = std::min(all_.sector_.section.tooth_rows() - 1, last_row + block_rings);
    block_.first_layer = std::max(0, first_layer - block_rings);
    block_.last_layer = std::min(surface.layers - 1, last_layer + block_rings);
    n_rows_ = block_.last_row - block_.first_row + 1;
    n_layers_ = block_.last_layer - block_.first_layer + 1;
    ni_ = n_rows_ * p_ + 1, nj_ = all_.depth_ * p_ + 1, nk_ = n_layers_ * p_ + 1;
    const int last_of_involute = surface.n_row_nodes() - 1 - block_.first_row * p_;
    block_.rows_of_nodes = std::min(ni_, last_of_involute + 1);
    block_.layers_of_nodes = nk_;
    tip_free_ = block_.first_row == 0;
    low_free_ = block_.first_layer == 0;
    high_free_ = block_.last_layer == surface.layers - 1;
    opposite_free_ = all_.depth_ == all_.sector_.section.tooth_columns();
  }

  FlankBlock FlankBlocks::Builder::build()
  {
    place_nodes();
    number_nodes();
    LayeredCholesky factor(layer_size_, last_coupled_);
    Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(3 * n_free_, 3 * n_cut_);
    assemble(factor, coupling);
    const bool positive = factor.factor();
    FLANK_ASSERT(positive, "block stiffness is positive definite");

    // Unit normal forces on the flank nodes, and by symmetry the functional that reads the normal
    // displacement.
    const Eigen::MatrixXd unit = unit_forces();
    Eigen::MatrixXd response = unit;
    factor.solve_in_place(response);
    block_.load_response = unit.transpose() * response;
    block_.cut_response = -response.transpose() * coupling;
    read_cut_on_flank();

    add_free_faces();
    block_.face_response.resize(unit.cols(), 3 * static_cast<Eigen::Index>(face_nodes_.size()));
    for (std::size_t v = 0; v < face_nodes_.size(); ++v)
      block_.face_response.middleCols<3>(3 * v) =
          response.middleRows<3>(3 * free_index_[face_nodes_[v]]).transpose();
    return std::move(block_);
  }

  std::vector<int> FlankBlocks::Builder::nodes_of(const int row, const int column, const int layer) const
  {
    std::vector<int> nodes(n_ * n_ * n_);
    for (int k = 0; k < n_; ++k)
      for (int j = 0; j < n_; ++j)
        for (int i = 0; i < n_; ++i)
          nodes[(k * n_ + j) * n_ + i] = id(row * p_ + i, column * p_ + j, layer * p_ + k);
    return nodes;
  }

  void FlankBlocks::Builder::place_nodes()
  {
    position_.resize(static_cast<std::size_t>(ni_) * nj_ * nk_);
    for (int layer = 0; layer < n_layers_; ++layer)
      for (int c = 0; c < all_.depth_; ++c)
        for (int row = 0; row < n_rows_; ++row)
          {
            const auto &of_body = all_.body_.cell_nodes(
                all_.sector_.tooth_cell(block_.first_row + row, c, block_.first_layer + layer));
            const std::vector<int> own = nodes_of(row, c, layer);
            for (std::size_t a = 0; a < own.size(); ++a)
              position_[own[a]] = all_.body_.node_positions()[of_body[a]];
          }
  }

  /// Free ones and those on the cut, both layer by layer.
  void FlankBlocks::Builder::number_nodes()
  {
    free_index_.assign(position_.size(), -1);
    cut_index_ = face_index_ = free_index_;
    for (int k = 0; k < nk_; ++k)
      {
        const int before = n_free_;
        for (int j = 0; j < nj_; ++j)
          for (int i = 0; i < ni_; ++i)
            {
              const bool cut = (i == 0 && !tip_free_) || i == ni_ - 1 || (j == nj_ - 1 && !opposite_free_) ||
                               (k == 0 && !low_free_) || (k == nk_ - 1 && !high_free_);
              (cut ? cut_index_ : free_index_)[id(i, j, k)] = cut ? n_cut_++ : n_free_++;
            }
        layer_size_.push_back(3 * (n_free_ - before));
        last_coupled_.push_back(std::min(nk_ - 1, (k / p_ + 1) * p_));
      }
    block_.cut_positions.resize(3, n_cut_);
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (cut_index_[v] >= 0)
        block_.cut_positions.col(cut_index_[v]) = position_[v];
  }

  /// Stiffness between the free nodes, and between them and the cut.
  void FlankBlocks::Builder::assemble(LayeredCholesky &factor, Eigen::MatrixXd &coupling) const
  {
    const int tooth_rows = all_.sector_.section.tooth_rows();
    for (int layer = 0; layer < n_layers_; ++layer)
      for (int c = 0; c < all_.depth_; ++c)
        for (int row = 0; row < n_rows_; ++row)
          {
            const auto &ke =
                all_.stiffness_[((block_.first_layer + layer) * tooth_rows + block_.first_row + row) *
                                    all_.depth_ +
                                c];
            const std::vector<int> local = nodes_of(row, c, layer);
            for (std::size_t b = 0; b < local.size(); ++b)
              {
                const int layer_b = local[b] / (ni_ * nj_), free_b = 3 * free_index_[local[b]],
                          cut_b = 3 * cut_index_[local[b]];
                const Eigen::Index begin = factor.begin(layer_b);
                for (std::size_t a = 0; a < local.size(); ++a)
                  if (const int free_a = 3 * free_index_[local[a]]; free_a >= 0)
                    {
                      if (free_b < 0)
                        coupling.block<3, 3>(free_a, cut_b) += ke.block<3, 3>(3 * a, 3 * b);
                      else if (free_a >= free_b)
                        factor.panel(layer_b).block<3, 3>(free_a - begin, free_b - begin) +=
                            ke.block<3, 3>(3 * a, 3 * b);
                    }
              }
          }
  }

  Eigen::MatrixXd FlankBlocks::Builder::unit_forces() const
  {
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * n_free_, block_.rows_of_nodes * block_.layers_of_nodes);
    for (int k = 0; k < block_.layers_of_nodes; ++k)
      for (int i = 0; i < block_.rows_of_nodes; ++i)
        if (const int f = free_index_[id(i, 0, k)]; f >= 0)
          unit.block<3, 1>(3 * f, block_.node(i, k)) = normal(i, k);
    return unit;
  }

  /// A flank node on the cut moves as it is told.
  void FlankBlocks::Builder::read_cut_on_flank()
  {
    for (int k = 0; k < block_.layers_of_nodes; ++k)
      for (int i = 0; i < block_.rows_of_nodes; ++i)
        if (const int c = cut_index_[id(i, 0, k)]; c >= 0)
          block_.cut_response.block<1, 3>(block_.node(i, k), 3 * c) = normal(i, k).transpose();
  }

  /// An element's face; its nodes' axes (first, second) are in cyclic order after `axis`, so that d1 x d2
  /// points along +axis.
  void FlankBlocks::Builder::add_face(const int axis, const bool high, const int first_element,
                                      const int second_element)
  {
    FlankBlock::Face face;
    const std::array<int, 3> size{ ni_, nj_, nk_ };
    for (int b = 0; b < n_; ++b)
      for (int a = 0; a < n_; ++a)
        {
          std::array<int, 3> ijk{};
          ijk[axis] = high ? size[axis] - 1 : 0;
          ijk[(axis + 1) % 3] = first_element * p_ + a;
          ijk[(axis + 2) % 3] = second_element * p_ + b;
          const int v = id(ijk[0], ijk[1], ijk[2]);
          if (free_index_[v] >= 0 && face_index_[v] < 0)
            {
              face_index_[v] = static_cast<int>(face_nodes_.size());
              face_nodes_.push_back(v);
            }
          face.nodes.push_back(face_index_[v]);
          face.positions.push_back(position_[v]);
        }
    face.outward = high ? 1 : -1;
    face.end = axis == 2 ? (high ? 1 : -1) : 0;
    block_.faces.push_back(std::move(face));
  }

  void FlankBlocks::Builder::add_free_faces()
  {
    const std::array<int, 3> elements{ n_rows_, all_.depth_, n_layers_ };
    const auto add_side = [&](const int axis, const bool high) {
      for (int second = 0; second < elements[(axis + 2) % 3]; ++second)
        for (int first = 0; first < elements[(axis + 1) % 3]; ++first)
          add_face(axis, high, first, second);
    };
    if (tip_free_)
      add_side(0, false);
    if (opposite_free_)
      add_side(1, true);
    if (low_free_)
      add_side(2, false);
    if (high_free_)
      add_side(2, true);
  }

  FlankBlock FlankBlocks::around(const int first_row, const int last_row, const int first_layer,
                                 const int last_layer) const
  {
    return Builder(*this, { first_row, last_row, first_layer, last_layer }).build();
  }
} // namespace flank
