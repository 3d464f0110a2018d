// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/tooth_sector.hpp"
#include "solver/elements/elastic_body.hpp"

#include <vector>

namespace flank
{
  /// The loaded flank's surface as the elements see it: rows along q = roll^2, layers along z, both linear in
  /// the elements' reference coordinates. Node (i, k): i = 0 at the tip counts rows' abscissas downwards, k =
  /// 0 at -b/2.
  struct FlankSurface
  {
    int degree, rows, layers;
    double q_tip, q_form;          ///< roll angle squared at the two edges [rad^2]
    double face_width;             ///< [mm]
    std::vector<double> abscissas; ///< of the element's nodes on [0,1]

    int n_row_nodes() const { return rows * degree + 1; }
    int n_layer_nodes() const { return layers * degree + 1; }
    int n_nodes() const { return n_row_nodes() * n_layer_nodes(); }
    int node(const int row_node, const int layer_node) const { return layer_node * n_row_nodes() + row_node; }

    /// Row coordinate (0 at the tip, `rows` at the form circle) of q, and layer coordinate (0 to `layers`) of
    /// z.
    double row_coordinate(const double q) const { return (q_tip - q) / (q_tip - q_form) * rows; }
    double layer_coordinate(const double z) const { return (z / face_width + 0.5) * layers; }

    /// q of a row coordinate [rad^2], z of a layer coordinate [mm].
    double q_of_row(const double row) const { return flank::q_of_row(q_tip, q_form, row, rows); }
    double z_of_layer(const double layer) const { return face_width * (layer / layers - 0.5); }

    /// q and z of a row or layer of nodes. [rad^2, mm]
    double q_at(int row_node) const;
    double z_at(int layer_node) const;
  };

  FlankSurface flank_surface(const ToothSector &sector);

  /// Inward unit normals of the flank nodes of tooth 0. 3 x n_nodes
  Eigen::Matrix3Xd flank_normals(const ToothSector &sector, const FlankSurface &surface);

  /// Mesh nodes of the flank, in the order of FlankSurface::node(), or of the plane of nodes `depth` below
  /// it. `tooth`: which sector of a body of several ones, counted from its first.
  std::vector<int> flank_nodes(const ToothSector &sector, const FlankSurface &surface,
                               const ElasticBody &body, int depth = 0, int tooth = 0);

  /// Nodes on the cut at +pitch/2 (plus side) or -pitch/2 of a tooth, same order on both; bore nodes left
  /// out.
  std::vector<int> cut_nodes(const ToothSector &sector, const ElasticBody &body, bool plus_side,
                             int tooth = 0);

  /// Marks the unknowns on the bore of `teeth` sectors.
  std::vector<char> bore_unknowns(const ToothSector &sector, const ElasticBody &body, int teeth = 1);
} // namespace flank
