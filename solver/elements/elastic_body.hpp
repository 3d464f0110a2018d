// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/hex_mesh.hpp"
#include "solver/linear/stiffness_matrix.hpp"

#include <Eigen/Dense>

#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace flank
{
  /// Axes of some nodes (columns, orthonormal), along which their displacements and forces count instead of
  /// x, y and z.
  using NodeAxes = std::map<int, Eigen::Matrix3d>;

  /// An element's stiffness, three unknowns a node, in the axes of those of its nodes that have some.
  inline void turn_into_axes(const NodeAxes &axes, const std::vector<int> &nodes, Eigen::MatrixXd &stiffness)
  {
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (const auto of_node = axes.find(nodes[a]); of_node != axes.end())
        {
          stiffness.middleRows<3>(3 * a) =
              (of_node->second.transpose() * stiffness.middleRows<3>(3 * a)).eval();
          stiffness.middleCols<3>(3 * a) = (stiffness.middleCols<3>(3 * a) * of_node->second).eval();
        }
  }

  /// Linear elasticity on a hexahedral mesh with Lagrange elements of degree 1 to 3 on Gauss-Lobatto nodes.
  /// Unknown 3*node + component. All of deal.II is behind this type.
  class ElasticBody
  {
  public:
    virtual ~ElasticBody() = default;

    virtual int degree() const = 0;
    virtual int n_nodes() const = 0;
    int n_unknowns() const { return 3 * n_nodes(); }

    /// Nodes of a cell, lexicographic in its reference axes: (degree+1)^3 of them.
    virtual const std::vector<int> &cell_nodes(int cell) const = 0;

    /// Node positions. [mm]
    virtual const std::vector<Eigen::Vector3d> &node_positions() const = 0;

    /// Node abscissas on [0,1] (Gauss-Lobatto), degree+1 of them.
    virtual const std::vector<double> &abscissas() const = 0;

    /// Element stiffness in the order of cell_nodes(), 3 components a node. [N/mm]
    Eigen::MatrixXd cell_stiffness(int cell) const;

    /// Element stiffness of each of some cells, one after the other.
    virtual void each_stiffness(
        const std::vector<int> &cells,
        const std::function<void(int cell, const Eigen::MatrixXd &stiffness)> &use) const = 0;

    virtual StiffnessMatrix stiffness(const NodeAxes &axes = {}) const = 0;

    /// Part (0 to parts - 1) of each cell when METIS cuts the mesh into parts of equal size with short
    /// borders.
    virtual std::vector<int> partition(int parts) const = 0;

    /// Consistent nodal load of a traction t(x, outward normal) [MPa] on one face of a cell; face 2*axis +
    /// side.
    virtual void add_traction(
        int cell, int face,
        const std::function<Eigen::Vector3d(const Eigen::Vector3d &, const Eigen::Vector3d &)> &traction,
        Eigen::VectorXd &load) const = 0;

    /// Position [mm], displacement [mm] and stress xx yy zz xy yz zx (tension positive) [MPa] at some points
    /// of a cell, a column a point.
    struct Samples
    {
      Eigen::Matrix3Xd position, displacement;
      Eigen::Matrix<double, 6, Eigen::Dynamic> stress;
    };

    /// Samples of each of some cells, one after the other, at reference points in [0,1]^3. Stress is that of
    /// the cell: it jumps between cells.
    virtual void each_sample(const std::vector<int> &cells, const std::vector<Eigen::Vector3d> &reference,
                             const Eigen::VectorXd &displacement,
                             const std::function<void(int cell, const Samples &samples)> &use) const = 0;

    /// Smallest Jacobian determinant over the quadrature points divided by the cell's mean, over all cells:
    /// <= 0 is a broken mesh.
    virtual double least_scaled_jacobian() const = 0;
  };

  /// youngs_modulus [MPa]. The geometry is the mesh's exact map, interpolated at the elements' nodes.
  std::unique_ptr<const ElasticBody> make_elastic_body(const HexMesh &mesh, int degree, double youngs_modulus,
                                                       double poissons_ratio);

  /// The tensor of six components xx yy zz xy yz zx.
  inline Eigen::Matrix3d stress_tensor(const Eigen::Matrix<double, 6, 1> &s)
  {
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    return tensor;
  }

  /// Gauss-Lobatto abscissas on [0,1] of a degree 1 to 3: degree + 1 of them.
  std::vector<double> lobatto_abscissas(int degree);
} // namespace flank
