// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/classical_split.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/matching/tangent_half_space.hpp"
#include "solver/elements/lagrange.hpp"

namespace flank
{
  namespace
  {
    int levels(const ClassicalDepth depth)
    {
      return depth == ClassicalDepth::half_element ? 1 : 2;
    } // of elements
  }   // namespace

  int depth_planes(const ClassicalDepth depth, const int degree)
  {
    return degree * levels(depth);
  }

  namespace
  {
    std::vector<double> depths_of(const ClassicalDepth depth)
    {
      return depth == ClassicalDepth::half_element ? std::vector<double>{ 0.5 }
                                                   : std::vector<double>{ 0.75, 1, 1.25, 1.5, 1.75, 2 };
    }

    /// Weights of the node planes at so many elements below the flank.
    Eigen::VectorXd plane_weights(const FlankSurface &s, const ClassicalDepth depth, const double elements)
    {
      const int p = s.degree, element = std::min(static_cast<int>(elements), levels(depth) - 1);
      Eigen::VectorXd w = Eigen::VectorXd::Zero(levels(depth) * p + 1);
      const auto values = LagrangePolynomials(s.abscissas).values(elements - element);
      for (int k = 0; k <= p; ++k)
        w[element * p + k] = values[k];
      return w;
    }
  } // namespace

  std::vector<Eigen::MatrixXd> responses_below(const FlankCompliance &far_field, const ClassicalDepth depth,
                                               const PatchWeights &loads)
  {
    const FlankSurface &s = far_field.surface;
    std::vector<Eigen::MatrixXd> result;
    for (const double elements : depths_of(depth))
      {
        const Eigen::VectorXd planes = plane_weights(s, depth, elements);
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
                           const PatchGroup &outputs, const PatchGroup &loads, Eigen::MatrixXd &c)
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
    for (std::size_t d = 0; d < depths.size(); ++d)
      {
        const Eigen::VectorXd planes = plane_weights(s, depth, depths[d]);
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
