// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/patch.hpp"
#include "contact/matching/flank_edges.hpp"
#include "contact/matching/piecewise_polynomial.hpp"
#include "mesh/base/shared_memory.hpp"
#include "solver/elements/flank_block.hpp"

#include <array>

namespace flank
{
  /// What the elements of a block make of the half-space, for a unit point force anywhere on its loaded
  /// elements: W = H f + G(x). H: the block's answer to nodal loads, cut held. G: its answer to Boussinesq's
  /// displacement on the cut and tractions on the true free faces, a smooth function of the source's place x
  /// (graded towards free edges), tabulated once for a body. Where the block reaches one end of the
  /// flank, or the tip of a spur gear, the half-space's field is that of wedges, which leave them free
  /// (FlankEdges).
  struct SourceTable
  {
    int first_row, last_row, first_layer,
        last_layer; ///< elements of the block, inclusive, counted as the body's at no shift
    int rows_of_nodes, layers_of_nodes;
    int node(const int row_node, const int layer_node) const { return layer_node * rows_of_nodes + row_node; }
    FreeEdges free; ///< whose wedges the half-space is; none: half-space theory alone

    SharedMatrix load_response;     ///< H [mm/N]
    PiecewisePolynomial row, layer; ///< of the source, element coordinates
    SharedMatrix source_response;   ///< G: flank nodes x (row.size() * layer.size()) [mm/N]

    /// The response to several sources as weights of G's columns, few of which differ from 0.
    class ColumnWeights
    {
    public:
      /// Starts anew for this table, which is kept by reference, without any source.
      void reset(const SourceTable &table);

      /// Adds sources at some row places and one layer place (element coordinates), each with its force.
      void add(const std::vector<double> &rows, double layer, const std::vector<double> &forces);

      const Eigen::VectorXd &weight() const { return weight_; }
      const std::vector<int> &used() const { return used_; } ///< columns with a weight

    private:
      const SourceTable *table_ = nullptr;
      Eigen::VectorXd weight_;
      std::vector<int> used_;
      std::vector<char> is_used_;
      std::vector<double> of_rows_; ///< of a layer place's sources; 0 between calls
    };
  };

  /// G at one place, computed without the table; `free`: as SourceTable::free; `points`:
  /// TableFineness::points, for its free faces. [mm/N] The table's columns are this function at the table's
  /// abscissas. Tests compare what the table interpolates between them with it.
  Eigen::VectorXd response_to_source(const FlankBlock &block, const FlankSurface &surface, const Gear &gear,
                                     const FlankEdges &edges, const FreeEdges &free, double row_at,
                                     double layer_at, int points = 5);

  /// How finely G is computed and tabulated. The default leaves 1.5e-3 of G within an element, some 1e-5 of
  /// the transmission error.
  struct TableFineness
  {
    int points = 5;     ///< of a polynomial on an interval; the quadratures over free faces follow
    double reach = 0.8; ///< longest interval, over its distance to the cut
  };

  /// Tabulates G for the block around loaded elements (inclusive ranges), half an element around them
  /// included.
  SourceTable make_source_table(const FlankBlock &block, const FlankSurface &surface, const Gear &gear,
                                const FlankEdges &edges, int first_row, int last_row, int first_layer,
                                int last_layer, const TableFineness &fineness = {});

  /// The table of the block that lies likewise at the other end of the flank, of so many layers of elements:
  /// of spur gears, whose bodies the mid-plane halves into mirror images.
  SourceTable mirrored(const SourceTable &table, int layers);
} // namespace flank
