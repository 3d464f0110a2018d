// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/fields/fillet_stress.hpp"

#include "mesh/base/errors.hpp"
#include "solver/elements/lagrange.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    constexpr int arc_points = 9; // of an element's edge along the fillet

    /// A quadrilateral of a section and where in it a point lies.
    struct PlaceInSection
    {
      int quad;
      Eigen::Vector2d reference;
    };

    /// Nodes of every quadrilateral of a sector's section at mid-face, lexicographic: where its elements,
    /// whose edges are polynomials, are.
    std::vector<Eigen::Matrix2Xd> quads_of(const BodyElements &elements)
    {
      const ToothSector &sector = elements.sector();
      const double z = -sector.gear.face_width / 2; // of the first plane of nodes
      const Eigen::Matrix2d back = Eigen::Rotation2Dd(-sector.gear.flank().twist() * z).toRotationMatrix();
      const int n = elements.body().degree() + 1;
      std::vector<Eigen::Matrix2Xd> quads;
      for (int quad = 0; quad < static_cast<int>(sector.section.quads().size()); ++quad)
        {
          Eigen::Matrix2Xd &nodes = quads.emplace_back(2, n * n);
          for (int i = 0; i < n * n; ++i)
            nodes.col(i) =
                back * elements.body().node_positions()[elements.body().cell_nodes(quad)[i]].head<2>();
        }
      return quads;
    }

    /// Reference coordinates of a point in a quadrilateral by Newton's method; far outside where it does not
    /// converge.
    Eigen::Vector2d reference_in(const LagrangePolynomials &polynomials, const Eigen::Matrix2Xd &nodes,
                                 const Eigen::Vector2d &point)
    {
      const int n = polynomials.size();
      Eigen::Vector2d x(0.5, 0.5);
      for (int iteration = 0; iteration < 30 && x.cwiseAbs().maxCoeff() < 3; ++iteration)
        {
          const auto down = polynomials.with_derivatives(x[0]), across = polynomials.with_derivatives(x[1]);
          Eigen::Vector2d off = -point;
          Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();
          for (int i = 0; i < n * n; ++i)
            {
              off += down.value[i % n] * across.value[i / n] * nodes.col(i);
              slope.col(0) += down.derivative[i % n] * across.value[i / n] * nodes.col(i);
              slope.col(1) += down.value[i % n] * across.derivative[i / n] * nodes.col(i);
            }
          const Eigen::Vector2d change = slope.inverse() * off;
          if (!change.allFinite())
            break;
          x -= change;
          if (change.cwiseAbs().maxCoeff() < 1e-12)
            return x;
        }
      return { 1e3, 1e3 };
    }

    /// The quadrilateral that a point lies in or next to. Throws ComputationError where there is none.
    PlaceInSection place_in(const LagrangePolynomials &polynomials,
                            const std::vector<Eigen::Matrix2Xd> &quads, const Eigen::Vector2d &point)
    {
      PlaceInSection best{ -1, {} };
      double least = 0.01; // what interpolated edges leave between elements and the surface
      for (std::size_t quad = 0; quad < quads.size(); ++quad)
        {
          const Eigen::Vector2d x = reference_in(polynomials, quads[quad], point);
          const double outside = std::max({ 0.0, -x.minCoeff(), x.maxCoeff() - 1 });
          if (outside < least)
            {
              best = { static_cast<int>(quad), x };
              least = outside;
            }
        }
      if (best.quad < 0)
        throw ComputationError(fmt::format("the root fillet's elements leave the tooth sector at ({}, {}) mm",
                                           point.x(), point.y()));
      return best;
    }
  } // namespace

  FilletStress::FilletStress(const BodyElements &elements)
      : fillets_{ std::make_unique<Submodel>(elements, 0), std::make_unique<Submodel>(elements, 1) }
  {
  }

  std::array<std::vector<double>, 2> FilletStress::greatest(const Eigen::VectorXd &displacement) const
  {
    return { fillets_[0]->greatest(displacement), fillets_[1]->greatest(displacement) };
  }

  FilletStress::Submodel::Submodel(const BodyElements &elements, const int side)
      : block(elements.sector(), side)
      , face_points(elements.body().abscissas())
      , body(make_elastic_body(block.mesh(), block_degree, elements.sector().gear.youngs_modulus,
                               elements.sector().gear.poissons_ratio))
  {
    hold_cut(elements);
    std::vector<char> fixed(body->n_unknowns(), 0);
    for (int unknown = 0; unknown < body->n_unknowns(); ++unknown)
      fixed[unknown] = held.row(unknown).nonZeros() > 0;
    solver = make_direct_solver(body->stiffness(), fixed);
  }

  /// The cut: both ends of the band and its innermost surface, where nodes have the displacement that the
  /// sector's elements have there. Layers are the sector's, so that only the section counts.
  void FilletStress::Submodel::hold_cut(const BodyElements &elements)
  {
    const ToothSector &sector = elements.sector();
    const int n_quads = static_cast<int>(sector.section.quads().size()), n = body->degree() + 1;
    const LagrangePolynomials polynomials(elements.body().abscissas());
    const int m = polynomials.size();
    const std::vector<Eigen::Matrix2Xd> quads = quads_of(elements);
    std::vector<char> done(body->n_nodes(), 0);
    std::vector<Eigen::Triplet<double>> entries;
    for (int a = 0; a < block.along(); ++a)
      for (int d = 0; d < block.deep(); ++d)
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j)
            {
              if (!((a == 0 && i == 0) || (a == block.along() - 1 && i == n - 1) ||
                    (d == block.deep() - 1 && j == n - 1)))
                continue;
              const PlaceInSection at = place_in(
                  polynomials, quads,
                  block.section_point(block.cell(a, d, 0), body->abscissas()[i], body->abscissas()[j]));
              const auto down = polynomials.values(at.reference[0]),
                         across = polynomials.values(at.reference[1]);
              for (int layer = 0; layer < block.layers(); ++layer)
                for (int k = 0; k < n; ++k)
                  {
                    const int node = body->cell_nodes(block.cell(a, d, layer))[(k * n + j) * n + i];
                    if (done[node]++)
                      continue;
                    const auto &of_sector = elements.body().cell_nodes(layer * n_quads + at.quad);
                    const auto up = polynomials.values(body->abscissas()[k]);
                    for (int corner = 0; corner < m * m * m; ++corner)
                      for (int c = 0; c < 3; ++c)
                        entries.emplace_back(3 * node + c, 3 * of_sector[corner] + c,
                                             down[corner % m] * across[corner / m % m] *
                                                 up[corner / (m * m)]);
                  }
            }
    held.resize(body->n_unknowns(), elements.body().n_unknowns());
    held.setFromTriplets(entries.begin(), entries.end());
  }

  std::vector<double> FilletStress::Submodel::greatest(const Eigen::VectorXd &displacement) const
  {
    const Eigen::VectorXd inside =
        solver->solve(Eigen::VectorXd::Zero(body->n_unknowns()), held * displacement);
    const int p = static_cast<int>(face_points.size()) - 1, n_points = arc_points - 1,
              along_face = block.layers() * p + 1,
              along_arc = (block.on_fillet()[1] - block.on_fillet()[0] + 1) * n_points + 1;
    std::vector<Eigen::Matrix3d> sum(static_cast<std::size_t>(along_face) * along_arc,
                                     Eigen::Matrix3d::Zero());
    std::vector<int> count(sum.size(), 0);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k <= p; ++k)
      for (int a = 0; a < arc_points; ++a)
        points.emplace_back(1.0 * a / n_points, 0, face_points[k]);
    std::vector<int> cells;
    for (int layer = 0; layer < block.layers(); ++layer)
      for (int c = block.on_fillet()[0]; c <= block.on_fillet()[1]; ++c)
        cells.push_back(block.cell(c, 0, layer));
    body->each_sample(cells, points, inside, [&](const int cell, const ElasticBody::Samples &samples) {
      const int layer = cell / (block.along() * block.deep()),
                first = (cell % block.along() - block.on_fillet()[0]) * n_points;
      for (int q = 0; q < static_cast<int>(points.size()); ++q)
        {
          const int at = (layer * p + q / arc_points) * along_arc + first + q % arc_points;
          sum[at] += stress_tensor(samples.stress.col(q));
          ++count[at];
        }
    });
    std::vector<double> result;
    for (int k = 0; k < along_face; ++k)
      {
        double most = -std::numeric_limits<double>::infinity();
        for (int a = 0; a < along_arc; ++a)
          {
            const int at = k * along_arc + a;
            most = std::max(most, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum[at] / count[at],
                                                                                 Eigen::EigenvaluesOnly)
                                      .eigenvalues()[2]);
          }
        result.push_back(most);
      }
    return result;
  }
} // namespace flank
