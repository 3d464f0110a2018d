// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/section_waves.hpp"

#include "contact/wedge/wave_load.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/elements/lagrange.hpp"
#include "solver/linear/layered_cholesky.hpp"

#include <cmath>

namespace flank::wedge
{
  namespace
  {
    constexpr int degree = 3, nodes = degree + 1;
    const std::array<double, nodes> lobatto = { 0, 0.5 - 0.5 / std::sqrt(5.0), 0.5 + 0.5 / std::sqrt(5.0),
                                                1 };

    /// Elements over the logarithm of the radius. At the outer end, some 40 inverse wave numbers away, a wave
    /// has died out; at the inner one the displacement is linear in the radius.
    constexpr double log_inner = -13.6, log_outer = 3.7, element_length = 0.38; // 45 elements
    const int elements = static_cast<int>(std::lround((log_outer - log_inner) / element_length));
    const double length = (log_outer - log_inner) / elements;

    LagrangePolynomials polynomials()
    {
      return LagrangePolynomials({ lobatto.begin(), lobatto.end() });
    }

    int elements_across(const double opening)
    {
      return std::max(4, static_cast<int>(std::ceil(opening / 0.3)));
    }

    /// Strains of an element's node: rows xx, ss, zz, sz, xs, xz; columns x, s, z. [per inverse wave number]
    Eigen::Matrix<double, 6, 3> strains(const double n, const double n_s, const double n_z)
    {
      Eigen::Matrix<double, 6, 3> b;
      b << n, 0, 0,    //
          0, n_s, 0,   //
          0, 0, n_z,   //
          0, n_z, n_s, //
          n_s, -n, 0,  //
          n_z, 0, -n;
      return b;
    }

    /// Stresses for strains, Young's modulus 1.
    Eigen::Matrix<double, 6, 6> elasticity(const double nu)
    {
      const double lambda = nu / ((1 + nu) * (1 - 2 * nu)), shear = 1 / (2 * (1 + nu));
      Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
      d.topLeftCorner<3, 3>().setConstant(lambda);
      d.diagonal().head<3>().array() += 2 * shear;
      d.diagonal().tail<3>().setConstant(shear);
      return d;
    }

    /// Stiffness of the element with corner (log_r, theta), node 4 a + b: a along the radius.
    Eigen::MatrixXd element_stiffness(const double log_r, const double theta, const double angle,
                                      const double nu)
    {
      const Eigen::Matrix<double, 6, 6> d = elasticity(nu);
      const LagrangePolynomials shape = polynomials();
      const GaussRule &rule = gauss(5);
      Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(3 * nodes * nodes, 3 * nodes * nodes);
      Eigen::Matrix<double, 6, 3 * nodes * nodes> b;
      for (std::size_t p = 0; p < rule.point.size(); ++p)
        for (std::size_t q = 0; q < rule.point.size(); ++q)
          {
            const auto along = shape.with_derivatives(rule.point[p]),
                       across = shape.with_derivatives(rule.point[q]);
            const double r = std::exp(log_r + length * rule.point[p]), at = theta + angle * rule.point[q],
                         c = std::cos(at), s = std::sin(at);
            for (int i = 0; i < nodes; ++i)
              for (int j = 0; j < nodes; ++j)
                {
                  const double n = along.value[i] * across.value[j],
                               by_log = along.derivative[i] * across.value[j] / length,
                               by_angle = along.value[i] * across.derivative[j] / angle;
                  b.middleCols<3>(3 * (nodes * i + j)) =
                      strains(n, (c * by_log - s * by_angle) / r, (s * by_log + c * by_angle) / r);
                }
            stiffness.noalias() +=
                rule.weight[p] * rule.weight[q] * length * angle * r * r * b.transpose() * d * b;
          }
      return stiffness;
    }
  } // namespace

  SectionWaves::SectionWaves(const double opening, const double poissons_ratio)
      : opening_(opening)
      , poissons_ratio_(poissons_ratio)
      , n_angles_(elements_across(opening) * degree + 1)
  {
  }

  double SectionWaves::angle(const int i) const
  {
    const int across = (n_angles_ - 1) / degree;
    return opening_ / across * (i / degree + lobatto[static_cast<std::size_t>(i % degree)]);
  }

  namespace
  {
    LayeredCholesky factored(const double opening, const double nu, const int n_angles)
    {
      const int across = (n_angles - 1) / degree, free_layers = elements * degree; // the outermost is held
      std::vector<Eigen::Index> size(static_cast<std::size_t>(free_layers), 3 * n_angles);
      std::vector<int> last;
      for (int t = 0; t < free_layers; ++t)
        last.push_back(std::min(free_layers - 1, (t / degree + 1) * degree));
      LayeredCholesky factor(size, last);
      const double angle = opening / across;
      for (int e = 0; e < elements; ++e)
        for (int f = 0; f < across; ++f)
          {
            const Eigen::MatrixXd ke = element_stiffness(log_inner + e * length, f * angle, angle, nu);
            const auto unknown = [&](const int a) {
              return 3 * ((e * degree + a / nodes) * n_angles + f * degree + a % nodes);
            };
            for (int b = 0; b < nodes * nodes; ++b)
              {
                const int layer = e * degree + b / nodes;
                if (layer >= free_layers)
                  continue;
                for (int a = 0; a < nodes * nodes; ++a)
                  if (e * degree + a / nodes < free_layers && unknown(a) >= unknown(b))
                    factor.panel(layer).block<3, 3>(unknown(a) - factor.begin(layer),
                                                    unknown(b) - factor.begin(layer)) +=
                        ke.block<3, 3>(3 * a, 3 * b);
              }
          }
      const bool positive = factor.factor();
      FLANK_ASSERT(positive, "a wedge's stiffness is positive definite");
      return factor;
    }

    /// Nodal forces that take off the other face what the half-space under a wave of line load at `distance`
    /// leaves there. The tractions are interpolated between the nodes.
    void add_tractions(const double distance, const double opening, const double nu, const int n_angles,
                       Eigen::Ref<Eigen::VectorXd> force)
    {
      const double n_s = -std::sin(opening), n_z = std::cos(opening);
      const int n = elements * degree + 1;
      Eigen::Matrix3Xd traction = Eigen::Matrix3Xd::Zero(3, n); // times the radius: per logarithm
      for (int i = 0; i < n; ++i)
        {
          const double r =
              std::exp(log_inner + length * (i / degree + lobatto[static_cast<std::size_t>(i % degree)]));
          if (r < 2e-5 * distance) // as much of the whole is left out
            continue;
          const WaveStress t = wave_load_stress(r * std::cos(opening) - distance, r * std::sin(opening), nu);
          traction.col(i) =
              -r * Eigen::Vector3d(t.xs * n_s + t.xz * n_z, t.ss * n_s + t.sz * n_z, t.sz * n_s + t.zz * n_z);
        }
      const LagrangePolynomials shape = polynomials();
      const GaussRule &rule = gauss(4);
      for (int e = 0; e < elements; ++e)
        for (std::size_t q = 0; q < rule.point.size(); ++q)
          {
            const auto value = shape.values(rule.point[q]);
            Eigen::Vector3d here = Eigen::Vector3d::Zero();
            for (int a = 0; a < nodes; ++a)
              here += value[a] * traction.col(e * degree + a);
            for (int a = 0; a < nodes; ++a)
              if (const int layer = e * degree + a; layer < elements * degree)
                force.segment<3>(3 * (layer * n_angles + n_angles - 1)) +=
                    rule.weight[q] * length * value[a] * here;
          }
    }
  } // namespace

  Eigen::MatrixXd SectionWaves::response(const Eigen::VectorXd &log_distance,
                                         const Eigen::VectorXd &log_radius) const
  {
    const LayeredCholesky factor = factored(opening_, poissons_ratio_, n_angles_);
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(factor.begin(factor.n_layers()), log_distance.size());
    parallel_for(static_cast<int>(log_distance.size()), [&](const int j) {
      add_tractions(std::exp(log_distance[j]), opening_, poissons_ratio_, n_angles_, u.col(j));
    });
    factor.solve_in_place(u);

    const LagrangePolynomials shape = polynomials();
    const Eigen::Index layer_size = 3 * n_angles_;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(layer_size * log_radius.size(), log_distance.size());
    for (Eigen::Index i = 0; i < log_radius.size(); ++i)
      {
        const double at = std::max(0.0, (log_radius[i] - log_inner) / length);
        const int e = static_cast<int>(at);
        if (e >= elements)
          continue;
        const auto value = shape.values(at - e);
        for (int a = 0; a < nodes; ++a)
          if (const int layer = e * degree + a; layer < elements * degree)
            result.middleRows(layer_size * i, layer_size) +=
                value[a] * u.middleRows(layer_size * layer, layer_size);
      }
    return result;
  }
} // namespace flank::wedge
