// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/tooth_sector.hpp"
#include "solver/elastic_body.hpp"

#include <vector>

namespace flank
{
  /// The loaded flank's surface as the elements see it: rows along q = roll^2, layers along z, both linear in the
  /// elements' reference coordinates. Node (i, k): i = 0 at the tip counts rows' abscissas downwards, k = 0 at -b/2.
  struct FlankSurface
  {
    int                 degree, rows, layers;
    double              q_tip, q_form; ///< roll angle squared at the two edges [rad^2]
    double              face_width;    ///< [mm]
    std::vector<double> abscissas;     ///< of the element's nodes on [0,1]

    int n_row_nodes() const { return rows * degree + 1; }
    int n_layer_nodes() const { return layers * degree + 1; }
    int n_nodes() const { return n_row_nodes() * n_layer_nodes(); }
    int node(const int row_node, const int layer_node) const { return layer_node * n_row_nodes() + row_node; }

    /// Row coordinate (0 at the tip, `rows` at the form circle) of q, and layer coordinate (0 to `layers`) of z.
    double row_coordinate(const double q) const { return (q_tip - q) / (q_tip - q_form) * rows; }
    double layer_coordinate(const double z) const { return (z / face_width + 0.5) * layers; }
    double q_at(int row_node) const;
    double z_at(int layer_node) const;
  };

  FlankSurface flank_surface(const ToothSector &sector);

  /// Reduced far-field operator of one body in its canonical frame.
  /// matrix[m](i, j): displacement of flank node i of tooth t+m along its inward normal for a unit force on flank node j
  /// of tooth t along that node's inward normal. [mm/N] m = 0 .. max_offset; the other side is the transpose.
  struct FlankCompliance
  {
    FlankSurface                 surface;
    std::vector<Eigen::MatrixXd> by_tooth_offset;

    /// For the classical split, if asked for: by_depth[d][i, j] is the response at the node below flank node i,
    /// d node planes into the tooth, along i's inward normal, same tooth. Empty otherwise.
    std::vector<Eigen::MatrixXd>  by_depth;
    std::vector<Eigen::Matrix3Xd> depth_positions; ///< [mm], of the same nodes
  };

  /// Inward unit normals of the flank nodes of tooth 0. 3 x n_nodes
  Eigen::Matrix3Xd flank_normals(const ToothSector &sector, const FlankSurface &surface);

  /// Mesh node of flank node n. Order of FlankSurface::node().
  std::vector<int> flank_nodes(const ToothSector &sector, const FlankSurface &surface, const ElasticBody &body, int depth = 0);

  /// Nodes on the cut at column 0 (+pitch/2) or the last column (-pitch/2), same order on both; bore nodes left out.
  std::vector<int> cut_nodes(const ToothSector &sector, const ElasticBody &body, bool plus_side);

  std::vector<char> bore_unknowns(const ToothSector &sector, const ElasticBody &body);

  /// Whole gear clamped at the bore, from one condensed sector by cyclic symmetry: the discrete Fourier transform over
  /// the teeth turns the ring into one small Hermitian system a harmonic. Exact for the finite-element model.
  /// depth_planes > 0 asks for the responses below the surface as well.
  FlankCompliance ring_compliance(const ToothSector &sector, const ElasticBody &body, int max_offset, int depth_planes = 0);
} // namespace flank
