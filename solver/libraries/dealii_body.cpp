// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/libraries/module.hpp"

#include "mesh/base/errors.hpp"
#include "solver/libraries/projected_dilatation.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace flank
{
  namespace
  {
    using Elasticity = Eigen::Matrix<double, 6, 6>;

    /// Lame's constants of a material. The stress is 2 mu strain + (lambda + projected) tr(strain), of which
    /// `projected` acts on the cell's projected dilatation alone: nothing up to Poisson's ratio 0.4, all from
    /// 0.45 on, a share that grows evenly between.
    struct Material
    {
      double mu, lambda, projected; ///< [MPa]

      Material(const double youngs_modulus, const double poissons_ratio)
          : mu(youngs_modulus / (2 * (1 + poissons_ratio)))
      {
        const double all =
                         youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio)),
                     share = std::clamp((poissons_ratio - 0.4) / 0.05, 0.0, 1.0);
        projected = share * all;
        lambda = all - projected;
      }

      /// Stress by strain, without the projected part: order xx yy zz xy yz zx with engineering shear.
      Elasticity hooke() const
      {
        Elasticity d = Elasticity::Zero();
        d.topLeftCorner<3, 3>().setConstant(lambda);
        d.diagonal() << lambda + 2 * mu, lambda + 2 * mu, lambda + 2 * mu, mu, mu, mu;
        return d;
      }
    };

    /// What an element's stiffness needs at its quadrature points.
    const auto of_stiffness = dealii::update_gradients | dealii::update_JxW_values |
                              dealii::update_quadrature_points | dealii::update_jacobians;

    Eigen::Vector3d vector(const dealii::Tensor<1, 3> &x)
    {
      return { x[0], x[1], x[2] };
    }
  } // namespace

  class DealiiBody final : public ElasticBody
  {
  public:
    DealiiBody(const HexMesh &mesh, const std::vector<double> &abscissas, double youngs_modulus,
               double poissons_ratio);

    int degree() const override { return static_cast<int>(element_.degree); }
    int n_nodes() const override { return static_cast<int>(positions_.size()); }
    const std::vector<int> &cell_nodes(const int cell) const override { return nodes_[cell]; }
    const std::vector<Eigen::Vector3d> &node_positions() const override { return positions_; }
    const std::vector<double> &abscissas() const override { return abscissas_; }

    void each_stiffness(const std::vector<int> &cells,
                        const std::function<void(int, const Eigen::MatrixXd &)> &use) const override;
    StiffnessMatrix stiffness(const NodeAxes &axes) const override;
    std::vector<int> partition(int parts) const override;
    void add_traction(
        int cell, int face,
        const std::function<Eigen::Vector3d(const Eigen::Vector3d &, const Eigen::Vector3d &)> &traction,
        Eigen::VectorXd &load) const override;
    void each_sample(const std::vector<int> &cells, const std::vector<Eigen::Vector3d> &reference,
                     const Eigen::VectorXd &displacement,
                     const std::function<void(int, const Samples &)> &use) const override;
    double least_scaled_jacobian() const override;

  private:
    void element_stiffness(const dealii::FEValues<3> &values, Eigen::MatrixXd &k) const;

    dealii::Triangulation<3> triangulation_;
    dealii::FE_Q<3> element_;
    dealii::DoFHandler<3> dof_handler_;
    dealii::MappingQCache<3> mapping_;
    std::vector<dealii::DoFHandler<3>::active_cell_iterator> cells_;
    std::vector<unsigned int> lexicographic_; ///< local index of the i-th lexicographic node
    std::vector<std::vector<int>> nodes_;
    std::vector<Eigen::Vector3d> positions_;
    std::vector<double> abscissas_;
    Elasticity elasticity_;
    double projected_; ///< modulus of the projected dilatation [MPa]
  };

  DealiiBody::DealiiBody(const HexMesh &mesh, const std::vector<double> &abscissas,
                         const double youngs_modulus, const double poissons_ratio)
      : element_(abscissas.size() - 1)
      , dof_handler_(triangulation_)
      , mapping_(element_.degree)
      , abscissas_(abscissas)
      , elasticity_(Material(youngs_modulus, poissons_ratio).hooke())
      , projected_(Material(youngs_modulus, poissons_ratio).projected)
  {

    std::vector<dealii::Point<3>> vertices;
    for (const auto &v : mesh.vertices)
      vertices.emplace_back(v.x(), v.y(), v.z());
    std::vector<dealii::CellData<3>> cells(mesh.cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      std::copy(mesh.cells[c].begin(), mesh.cells[c].end(), cells[c].vertices.begin());
    triangulation_.create_triangulation(vertices, cells, dealii::SubCellData());

    const dealii::FE_Q<3> geometry(degree());
    const auto &support = geometry.get_unit_support_points();
    mapping_.initialize(triangulation_, [&](const auto &cell) {
      std::vector<dealii::Point<3>> points(support.size());
      for (std::size_t i = 0; i < support.size(); ++i)
        {
          const Eigen::Vector3d x =
              mesh.map(cell->active_cell_index(), { support[i][0], support[i][1], support[i][2] });
          points[i] = { x.x(), x.y(), x.z() };
        }
      return points;
    });

    dof_handler_.distribute_dofs(element_);
    lexicographic_ = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(degree());
    const int n = element_.n_dofs_per_cell();
    positions_.resize(dof_handler_.n_dofs());
    std::vector<dealii::types::global_dof_index> indices(n);
    for (const auto &cell : dof_handler_.active_cell_iterators())
      {
        const int c = cell->active_cell_index();
        FLANK_ASSERT(c == static_cast<int>(cells_.size()), "cells in creation order");
        for (int i = 0; i < 8; ++i)
          FLANK_ASSERT(static_cast<int>(cell->vertex_index(i)) == mesh.cells[c][i],
                       "deal.II kept the vertex order");
        cells_.push_back(cell);
        cell->get_dof_indices(indices);
        std::vector<int> nodes(n);
        for (int i = 0; i < n; ++i)
          {
            nodes[i] = static_cast<int>(indices[lexicographic_[i]]);
            const auto &x = support[lexicographic_[i]];
            positions_[nodes[i]] = mesh.map(c, { x[0], x[1], x[2] });
          }
        nodes_.push_back(std::move(nodes));
      }
  }

  void DealiiBody::element_stiffness(const dealii::FEValues<3> &values, Eigen::MatrixXd &k) const
  {
    const int n = element_.n_dofs_per_cell();
    Eigen::MatrixXd strain = Eigen::MatrixXd::Zero(6, 3 * n);
    k.setZero(3 * n, 3 * n);
    for (const unsigned int q : values.quadrature_point_indices())
      {
        for (int i = 0; i < n; ++i)
          {
            const auto &g = values.shape_grad(lexicographic_[i], q);
            strain(0, 3 * i) = strain(3, 3 * i + 1) = strain(5, 3 * i + 2) = g[0];
            strain(1, 3 * i + 1) = strain(3, 3 * i) = strain(4, 3 * i + 2) = g[1];
            strain(2, 3 * i + 2) = strain(4, 3 * i + 1) = strain(5, 3 * i) = g[2];
          }
        k.noalias() += strain.transpose() * (values.JxW(q) * elasticity_ * strain);
      }
    if (projected_ > 0)
      {
        ProjectedDilatation dilatation(degree());
        dilatation.reinit(values, lexicographic_);
        k += projected_ * dilatation.square();
      }
    k = (0.5 * (k + k.transpose())).eval();
  }

  void DealiiBody::each_stiffness(const std::vector<int> &cells,
                                  const std::function<void(int, const Eigen::MatrixXd &)> &use) const
  {
    const dealii::QGauss<3> quadrature(degree() + 1);
    dealii::FEValues<3> values(mapping_, element_, quadrature, of_stiffness);
    Eigen::MatrixXd k;
    for (const int cell : cells)
      {
        values.reinit(cells_[cell]);
        element_stiffness(values, k);
        use(cell, k);
      }
  }

  std::vector<int> DealiiBody::partition(const int parts) const
  {
    std::vector<int> result(cells_.size(), 0);
    if (parts == 1)
      return result;
    dealii::Triangulation<3> copy; // parts are marks on the cells
    copy.copy_triangulation(triangulation_);
    dealii::GridTools::partition_triangulation(parts, copy, dealii::SparsityTools::Partitioner::metis);
    for (const auto &cell : copy.active_cell_iterators())
      result[cell->active_cell_index()] = static_cast<int>(cell->subdomain_id());
    return result;
  }

  StiffnessMatrix DealiiBody::stiffness(const NodeAxes &axes) const
  {
    const int n = element_.n_dofs_per_cell();

    // Node-to-node pattern, then a row of three unknowns each.
    std::vector<std::vector<int>> neighbours(n_nodes());
    for (const auto &nodes : nodes_)
      for (const int a : nodes)
        neighbours[a].insert(neighbours[a].end(), nodes.begin(), nodes.end());
    std::vector<int> starts(3 * n_nodes() + 1, 0);
    for (int a = 0; a < n_nodes(); ++a)
      {
        auto &list = neighbours[a];
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        for (int c = 0; c < 3; ++c)
          starts[3 * a + c + 1] = starts[3 * a + c] + 3 * static_cast<int>(list.size());
      }
    StiffnessMatrix matrix(n_unknowns(), n_unknowns());
    matrix.resizeNonZeros(starts.back());
    std::copy(starts.begin(), starts.end(), matrix.outerIndexPtr());
    std::fill_n(matrix.valuePtr(), starts.back(), 0.0);
    for (int a = 0; a < n_nodes(); ++a)
      for (int c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < neighbours[a].size(); ++k)
          for (int d = 0; d < 3; ++d)
            matrix.innerIndexPtr()[starts[3 * a + c] + 3 * k + d] = 3 * neighbours[a][k] + d;

    std::vector<int> all(cells_.size());
    std::iota(all.begin(), all.end(), 0);
    Eigen::MatrixXd k;
    each_stiffness(all, [&](const int c, const Eigen::MatrixXd &of_cell) {
      const auto &nodes = nodes_[c];
      k = of_cell;
      turn_into_axes(axes, nodes, k);
      for (int a = 0; a < n; ++a)
        {
          const auto &list = neighbours[nodes[a]];
          for (int b = 0; b < n; ++b)
            {
              const int position =
                  3 * static_cast<int>(std::lower_bound(list.begin(), list.end(), nodes[b]) - list.begin());
              for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                  matrix.valuePtr()[starts[3 * nodes[a] + i] + position + j] += k(3 * a + i, 3 * b + j);
            }
        }
    });
    return matrix;
  }

  void DealiiBody::add_traction(
      const int cell, const int face,
      const std::function<Eigen::Vector3d(const Eigen::Vector3d &, const Eigen::Vector3d &)> &traction,
      Eigen::VectorXd &load) const
  {
    const dealii::QGauss<2> quadrature(degree() + 3);
    dealii::FEFaceValues<3> values(mapping_, element_, quadrature,
                                   dealii::update_values | dealii::update_quadrature_points |
                                       dealii::update_normal_vectors | dealii::update_JxW_values);
    values.reinit(cells_[cell], face);
    for (const unsigned int q : values.quadrature_point_indices())
      {
        const auto &x = values.quadrature_point(q);
        const Eigen::Vector3d t =
            values.JxW(q) * traction({ x[0], x[1], x[2] }, vector(values.normal_vector(q)));
        for (std::size_t i = 0; i < nodes_[cell].size(); ++i)
          load.segment<3>(3 * nodes_[cell][i]) += values.shape_value(lexicographic_[i], q) * t;
      }
  }

  void DealiiBody::each_sample(const std::vector<int> &cells, const std::vector<Eigen::Vector3d> &reference,
                               const Eigen::VectorXd &displacement,
                               const std::function<void(int, const Samples &)> &use) const
  {
    std::vector<dealii::Point<3>> points;
    for (const Eigen::Vector3d &x : reference)
      points.emplace_back(x.x(), x.y(), x.z());
    const dealii::Quadrature<3> quadrature(points);
    dealii::FEValues<3> values(mapping_, element_, quadrature,
                               dealii::update_values | dealii::update_gradients |
                                   dealii::update_quadrature_points);
    const auto n = static_cast<Eigen::Index>(points.size());
    Samples samples{ Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n),
                     Eigen::Matrix<double, 6, Eigen::Dynamic>(6, n) };
    std::optional<dealii::FEValues<3>> inside;
    if (projected_ > 0)
      inside.emplace(mapping_, element_, dealii::QGauss<3>(degree() + 1), of_stiffness);
    ProjectedDilatation dilatation(degree());
    Eigen::VectorXd of_nodes(3 * static_cast<Eigen::Index>(element_.n_dofs_per_cell()));
    for (const int cell : cells)
      {
        values.reinit(cells_[cell]);
        for (std::size_t i = 0; i < nodes_[cell].size(); ++i)
          of_nodes.segment<3>(3 * i) = displacement.segment<3>(3 * nodes_[cell][i]);
        if (inside)
          {
            inside->reinit(cells_[cell]);
            dilatation.reinit(*inside, lexicographic_);
          }
        for (Eigen::Index q = 0; q < n; ++q)
          {
            samples.position.col(q) = vector(values.quadrature_point(q));
            Eigen::Vector3d u = Eigen::Vector3d::Zero();
            Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero(); // du_i/dx_j
            for (std::size_t i = 0; i < nodes_[cell].size(); ++i)
              {
                const Eigen::Vector3d at = of_nodes.segment<3>(3 * i);
                u += values.shape_value(lexicographic_[i], q) * at;
                gradient += at * vector(values.shape_grad(lexicographic_[i], q)).transpose();
              }
            samples.displacement.col(q) = u;
            Eigen::Matrix<double, 6, 1> strain;
            strain << gradient.diagonal(), gradient(0, 1) + gradient(1, 0), gradient(1, 2) + gradient(2, 1),
                gradient(2, 0) + gradient(0, 2);
            samples.stress.col(q) = elasticity_ * strain;
            if (inside)
              samples.stress.col(q).head<3>().array() +=
                  projected_ * dilatation.at(values.quadrature_point(q)).dot(of_nodes);
          }
        use(cell, samples);
      }
  }

  double DealiiBody::least_scaled_jacobian() const
  {
    const dealii::QGauss<3> quadrature(degree() + 1);
    dealii::FEValues<3> values(mapping_, element_, quadrature, dealii::update_JxW_values);
    double least = 1e300;
    for (const auto &cell : cells_)
      {
        values.reinit(cell);
        double volume = 0, lowest = 1e300;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            volume += values.JxW(q);
            lowest = std::min(lowest, values.JxW(q) / quadrature.weight(q));
          }
        least = std::min(least, lowest / volume);
      }
    return least;
  }

  std::unique_ptr<const ElasticBody> dealii_body(const HexMesh &mesh, const std::vector<double> &abscissas,
                                                 const double youngs_modulus, const double poissons_ratio)
  {
    return std::make_unique<const DealiiBody>(mesh, abscissas, youngs_modulus, poissons_ratio);
  }
} // namespace flank
