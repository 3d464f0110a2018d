// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/source_table.hpp"

#include "contact/matching/free_face_forces.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  void SourceTable::ColumnWeights::reset(const SourceTable &table)
  {
    table_ = &table;
    for (const int k : used_)
      weight_[k] = is_used_[k] = 0;
    used_.clear();
    if (weight_.size() != table.source_response.cols())
      {
        weight_.setZero(table.source_response.cols());
        is_used_.assign(weight_.size(), 0);
      }
    of_rows_.resize(table.row.size(), 0.0);
  }

  void SourceTable::ColumnWeights::add(const std::vector<double> &rows, const double layer,
                                       const std::vector<double> &forces)
  {
    std::array<double, PiecewisePolynomial::max_points> weights{};
    int first = 0, low = table_->row.size(), high = 0;
    for (std::size_t s = 0; s < rows.size(); ++s)
      {
        table_->row.weights(rows[s], first, weights);
        low = std::min(low, first);
        high = std::max(high, first + table_->row.points);
        for (int r = 0; r < table_->row.points; ++r)
          of_rows_[first + r] += forces[s] * weights[r];
      }
    table_->layer.weights(layer, first, weights);
    for (int l = 0; l < table_->layer.points; ++l)
      for (int r = low; r < high; ++r)
        {
          const int k = (first + l) * table_->row.size() + r;
          if (!is_used_[k])
            used_.push_back(k);
          is_used_[k] = 1;
          weight_[k] += weights[l] * of_rows_[r];
        }
    std::fill(of_rows_.begin() + low, of_rows_.begin() + high, 0.0);
  }

  namespace
  {
    /// Intervals over [low, high] of element coordinates. Towards a free edge at zero or at `end` they are
    /// halved: G behaves there like the distance times its logarithm. Along a free edge they end where
    /// elements do, with a short one on either side: a source close to the edge loads the free face nearby,
    /// and the face's shape functions have kinks there. `reach(a, b)`: their length over their distance to
    /// the cut.
    template <class Reach>
    PiecewisePolynomial intervals(const double low, const double high, const bool edge_at_zero,
                                  const bool edge_at_end, const double end, const bool along_edge,
                                  const TableFineness &fineness, const Reach &reach)
    {
      std::vector<double> breaks{ low, high };
      for (double distance = 2; distance > 1.0 / 40; distance /= 2)
        {
          if (edge_at_zero)
            breaks.push_back(distance);
          if (edge_at_end)
            breaks.push_back(end - distance);
        }
      if (along_edge)
        for (double at = std::ceil(low); at <= high; ++at)
          for (const double beside : { -0.125, 0.0, 0.125 })
            breaks.push_back(at + beside);
      std::erase_if(breaks, [&](const double b) { return b < low || b > high; });
      std::sort(breaks.begin(), breaks.end());
      breaks.erase(std::unique(breaks.begin(), breaks.end(),
                               [](const double a, const double b) { return b - a < 1e-9; }),
                   breaks.end());
      for (std::size_t k = 0; k + 1 < breaks.size();)
        if (breaks[k + 1] - breaks[k] > 0.05 && reach(breaks[k], breaks[k + 1]) > fineness.reach)
          breaks.insert(breaks.begin() + k + 1, 0.5 * (breaks[k] + breaks[k + 1]));
        else
          ++k;
      return { breaks, fineness.points };
    }

    /// Data of unit point forces for the block: displacements of the cut, forces on the free faces; a column
    /// a source.
    class SourceData
    {
    public:
      SourceData(const FlankBlock &block, const FlankSurface &surface, const Gear &gear,
                 const FlankEdges &edges, const FreeEdges &free, const int points, const int n_sources)
          : cut(block.cut_positions.size(), n_sources)
          , faces(Eigen::MatrixXd::Zero(block.face_response.cols(), n_sources))
          , block_(block)
          , surface_(surface)
          , edges_(edges)
          , free_(free)
          , helicoid_(gear.flank())
          , free_faces_(block, LagrangePolynomials(surface.abscissas), points)
      {
      }

      void set(const int column, const double row_at, const double layer_at)
      {
        const double roll = std::sqrt(std::max(0.0, surface_.q_of_row(row_at))),
                     z = surface_.z_of_layer(layer_at);
        const TangentHalfSpace below(helicoid_.frame(roll, z));
        for (Eigen::Index c = 0; c < block_.cut_positions.cols(); ++c)
          cut.block<3, 1>(3 * c, column) =
              below.axes() *
              edges_.displacement(free_, { roll, z },
                                  TangentHalfSpace::inside(below.relative(block_.cut_positions.col(c))));
        free_faces_.add(below, { edges_, free_, { roll, z } }, faces.col(column));
      }

      Eigen::MatrixXd response() const
      {
        Eigen::MatrixXd result = block_.cut_response * cut;
        if (!block_.faces.empty())
          result.noalias() += block_.face_response * faces;
        return result;
      }

    private:
      Eigen::MatrixXd cut, faces;
      const FlankBlock &block_;
      const FlankSurface &surface_;
      const FlankEdges &edges_;
      FreeEdges free_;
      InvoluteHelicoid helicoid_;
      FreeFaceForces free_faces_;
    };
  } // namespace

  Eigen::VectorXd response_to_source(const FlankBlock &block, const FlankSurface &surface, const Gear &gear,
                                     const FlankEdges &edges, const FreeEdges &free, const double row_at,
                                     const double layer_at, const int points)
  {
    SourceData data(block, surface, gear, edges, free, points, 1);
    data.set(0, row_at, layer_at);
    return data.response();
  }

  SourceTable make_source_table(const FlankBlock &block, const FlankSurface &surface, const Gear &gear,
                                const FlankEdges &edges, const int first_row, const int last_row,
                                const int first_layer, const int last_layer, const TableFineness &fineness)
  {
    SourceTable table{ .first_row = block.first_row,
                       .last_row = block.last_row,
                       .first_layer = block.first_layer,
                       .last_layer = block.last_layer,
                       .rows_of_nodes = block.rows_of_nodes,
                       .layers_of_nodes = block.layers_of_nodes,
                       .free = edges.edges_of({ block.first_layer, block.last_layer },
                                              { first_layer, last_layer }, first_row, surface.layers),
                       .load_response = block.load_response,
                       .row = {},
                       .layer = {},
                       .source_response = {} };
    const double rows = surface.rows, layers = surface.layers;
    const double row_low = std::max(0.0, first_row - 0.5), row_high = std::min(rows, last_row + 1.5),
                 layer_low = std::max(0.0, first_layer - 0.5),
                 layer_high = std::min(layers, last_layer + 1.5);
    const InvoluteHelicoid helicoid = gear.flank();
    const auto place = [&](const double row, const double layer) {
      const double roll = std::sqrt(std::max(0.0, surface.q_of_row(row)));
      return helicoid.frame(roll, surface.z_of_layer(layer)).origin;
    };
    const auto to_cut = [&](const Eigen::Vector3d &x) {
      return std::sqrt((block.cut_positions.colwise() - x).colwise().squaredNorm().minCoeff());
    };
    const auto reach_of_rows = [&](const double a, const double b) {
      const double middle = 0.5 * (layer_low + layer_high);
      return (place(a, middle) - place(b, middle)).norm() /
             std::min(to_cut(place(a, middle)), to_cut(place(b, middle)));
    };
    const auto reach_of_layers = [&](const double a, const double b) {
      const double middle = 0.5 * (row_low + row_high);
      return (place(middle, a) - place(middle, b)).norm() /
             std::min(to_cut(place(middle, a)), to_cut(place(middle, b)));
    };
    // Edges that carry tractions; those that the field leaves free make no difference to G's smoothness, but
    // in the element where they meet: each loads the other's face there.
    const bool at_tip = block.first_row == 0, at_low = block.first_layer == 0,
               at_high = block.last_layer == surface.layers - 1, tip = at_tip && !table.free.tip,
               low = at_low && table.free.end != FlankEnd::low,
               high = at_high && table.free.end != FlankEnd::high,
               low_corner = table.free.tip && table.free.end == FlankEnd::low && first_layer == 0,
               high_corner =
                   table.free.tip && table.free.end == FlankEnd::high && last_layer == surface.layers - 1;
    table.row = intervals(row_low, row_high, tip || low_corner || high_corner, false, rows, low || high,
                          fineness, reach_of_rows);
    table.layer = intervals(layer_low, layer_high, low || low_corner, high || high_corner, layers, tip,
                            fineness, reach_of_layers);
    const int n_rows = table.row.size(), n_sources = n_rows * table.layer.size();
    SourceData data(block, surface, gear, edges, table.free, fineness.points, n_sources);
    for (int s = 0; s < n_sources; ++s)
      data.set(s, table.row.abscissa(s % n_rows), table.layer.abscissa(s / n_rows));
    table.source_response = data.response();
    return table;
  }

  SourceTable mirrored(const SourceTable &table, const int layers)
  {
    SourceTable result = table;
    result.first_layer = layers - 1 - table.last_layer;
    result.last_layer = layers - 1 - table.first_layer;
    result.free.end = table.free.end == FlankEnd::low    ? FlankEnd::high
                      : table.free.end == FlankEnd::high ? FlankEnd::low
                                                         : FlankEnd::none;
    for (std::size_t k = 0; k < table.layer.breaks.size(); ++k)
      result.layer.breaks[k] = layers - table.layer.breaks[table.layer.breaks.size() - 1 - k];
    // Rows stay, layers of nodes and of sources run the other way.
    const auto reversed = [](const Eigen::Index size, const Eigen::Index rows) {
      Eigen::VectorXi order(size);
      for (Eigen::Index k = 0; k < size; ++k)
        order[k] = static_cast<int>((size / rows - 1 - k / rows) * rows + k % rows);
      return order;
    };
    const Eigen::VectorXi nodes = reversed(table.load_response.rows(), table.rows_of_nodes),
                          sources = reversed(table.source_response.cols(), table.row.size());
    result.load_response = Eigen::MatrixXd(table.load_response(nodes, nodes));
    result.source_response = Eigen::MatrixXd(table.source_response(nodes, sources));
    return result;
  }
} // namespace flank
