// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/classical_split.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/matching/tangent_half_space.hpp"
#include "solver/elements/lagrange.hpp"

namespace flank
{
  namespace
  {
    /// In widths of equal columns across the tooth.
    std::vector<double> depths_of(const ClassicalDepth depth)
    {
      return depth == ClassicalDepth::half_element ? std::vector<double>{ 0.5 }
                                                   : std::vector<double>{ 0.75, 1, 1.25, 1.5, 1.75, 2 };
    }

    /// The column that a share of the way across the tooth lies in.
    int column_at(const double share, const int columns)
    {
      int column = 0;
      while (column + 1 < columns && across_tooth((column + 1.0) / columns) < share)
        ++column;
      return column;
    }

    /// Weights of the planes of nodes for every depth: columns are linear in their elements' coordinates.
    std::vector<Eigen::VectorXd> plane_weights(const ClassicalDepth depth, const SectorResolution &resolution)
    {
      const int p = resolution.degree, columns = resolution.tooth_columns;
      const LagrangePolynomials polynomials(lobatto_abscissas(p));
      std::vector<Eigen::VectorXd> result;
      for (const double widths : depths_of(depth))
        {
          const double share = std::min(widths / columns, 1.0);
          const int column = column_at(share, columns);
          const double begin = across_tooth(1.0 * column / columns),
                       end = across_tooth((column + 1.0) / columns);
          const auto values = polynomials.values((share - begin) / (end - begin));
          Eigen::VectorXd &w =
              result.emplace_back(Eigen::VectorXd::Zero(depth_planes(depth, resolution) + 1));
          for (int k = 0; k <= p; ++k)
            w[column * p + k] = values[k];
        }
      return result;
    }
  } // namespace

  int depth_planes(const ClassicalDepth depth, const SectorResolution &resolution)
  {
    const double deepest = depths_of(depth).back() / resolution.tooth_columns;
    return resolution.degree * (column_at(std::min(deepest, 1.0), resolution.tooth_columns) + 1);
  }

  std::vector<Eigen::MatrixXd> responses_below(const FlankCompliance &far_field, const ClassicalDepth depth,
                                               const SectorResolution &resolution, const PatchWeights &loads)
  {
    const FlankSurface &s = far_field.surface;
    std::vector<Eigen::MatrixXd> result;
    for (const Eigen::VectorXd &planes : plane_weights(depth, resolution))
      {
        result.emplace_back(Eigen::MatrixXd::Zero(s.n_nodes(), static_cast<Eigen::Index>(loads.size())));
        for (Eigen::Index plane = 0; plane < planes.size(); ++plane)
          for (std::size_t j = 0; planes[plane] != 0 && j < loads.size(); ++j)
            for (std::size_t k = 0; k < loads.nodes(j).size(); ++k)
              result.back().col(static_cast<Eigen::Index>(j)) +=
                  planes[plane] * loads.values(j)[k] * far_field.by_depth[plane].col(loads.nodes(j)[k]);
      }
    return result;
  }

  void add_classical_split(const FlankCompliance &far_field, const Gear &gear, const ClassicalDepth depth,
                           const SectorResolution &resolution, const PatchGroup &outputs,
                           const PatchGroup &loads, Eigen::MatrixXd &c)
  {
    const InvoluteHelicoid helicoid = gear.flank();
    const FlankSurface &s = far_field.surface;
    const double e = gear.youngs_modulus, nu = gear.poissons_ratio,
                 scale = half_space::surface_compliance(e, nu);
    const std::vector<double> depths = depths_of(depth);
    // Weights of the depths that extrapolate to zero (one depth: itself).
    Eigen::VectorXd extrapolate = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(depths.size()));
    if (depths.size() > 1)
      {
        const Eigen::Map<const Eigen::VectorXd> d(depths.data(), static_cast<Eigen::Index>(depths.size()));
        const double mean = d.mean(), variance = (d.array() - mean).square().sum();
        extrapolate =
            (1.0 / static_cast<double>(depths.size()) - mean * (d.array() - mean) / variance).matrix();
      }
    const std::vector<Eigen::VectorXd> weights = plane_weights(depth, resolution);
    for (std::size_t d = 0; d < depths.size(); ++d)
      {
        const Eigen::VectorXd &planes = weights[d];
        Eigen::Matrix3Xd position = Eigen::Matrix3Xd::Zero(3, s.n_nodes());
        for (Eigen::Index plane = 0; plane < planes.size(); ++plane)
          position += planes[plane] * far_field.depth_positions[plane];
        for (std::size_t j = 0; j < loads.patches.size(); ++j)
          {
            const Patch &load = loads.patches[j];
            const TangentHalfSpace below(helicoid.frame(load.roll, load.z));
            for (std::size_t i = 0; i < outputs.patches.size(); ++i)
              {
                const auto nodes = outputs.weights.nodes(i);
                const auto values = outputs.weights.values(i);
                double elements = 0;
                Eigen::Vector3d q = Eigen::Vector3d::Zero();
                for (std::size_t k = 0; k < nodes.size(); ++k)
                  {
                    elements += values[k] * loads.below[d](nodes[k], j);
                    q += values[k] * position.col(nodes[k]);
                  }
                Eigen::Vector3d local = below.relative(q);
                local.z() = std::max(local.z(), 1e-5 * load.half_profile);
                const double near =
                    half_space::love_displacement(load.half_profile, load.half_generator, local, e, nu).z();
                c(i, j) += extrapolate[d] * (elements - near);
              }
          }
      }
    for (std::size_t j = 0; j < loads.patches.size(); ++j)
      for (std::size_t i = 0; i < outputs.patches.size(); ++i)
        {
          const Patch &load = loads.patches[j], &output = outputs.patches[i];
          const Eigen::Vector2d d = output.seen_from(load, helicoid);
          c(i, j) += scale * half_space::mean_love_potential(
                                 { 0, 0, load.half_profile, load.half_generator },
                                 { d.x(), d.y(), output.half_profile, output.half_generator });
        }
  }
} // namespace flank
