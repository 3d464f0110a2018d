// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/body/classical_split.hpp"

#include "contact/half_space/half_space.hpp"

#include <array>

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

  void add_classical_split(const FlankCompliance &far_field, const Gear &gear, const ClassicalDepth depth,
                           const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, Eigen::MatrixXd &c)
  {
    const InvoluteHelicoid helicoid = gear.flank();
    const FlankSurface    &s        = far_field.surface;
    const double           e = gear.youngs_modulus, nu = gear.poissons_ratio, scale = half_space::surface_compliance(e, nu);
    const int              p = s.degree, n_levels = levels(depth);
    std::vector<double>    depths =
        depth == ClassicalDepth::half_element ? std::vector<double>{ 0.5 } : std::vector<double>{ 0.75, 1, 1.25, 1.5, 1.75, 2 };
    std::vector<Eigen::VectorXd> plane_weights; // of the node planes for each depth, in elements
    for (const double d : depths)
      {
        Eigen::VectorXd       w       = Eigen::VectorXd::Zero(n_levels * p + 1);
        const int             element = std::min(static_cast<int>(d), n_levels - 1);
        std::array<double, 4> values{};
        lagrange(s.abscissas, d - element, values.data());
        for (int k = 0; k <= p; ++k)
          w[element * p + k] = values[k];
        plane_weights.push_back(w);
      }
    // Weights of the depths that extrapolate to zero (one depth: itself).
    Eigen::VectorXd extrapolate = Eigen::VectorXd::Ones(depths.size());
    if (depths.size() > 1)
      {
        const Eigen::Map<const Eigen::VectorXd> d(depths.data(), depths.size());
        const double                            mean = d.mean(), variance = (d.array() - mean).square().sum();
        extrapolate = (1.0 / depths.size() - mean * (d.array() - mean) / variance).matrix();
      }
    Eigen::MatrixXd load(s.n_nodes(), patches.size());
    load.setZero();
    for (std::size_t j = 0; j < patches.size(); ++j)
      for (std::size_t k = 0; k < weights[j].value.size(); ++k)
        load(s.node(weights[j].row_node[k], weights[j].layer_node[k]), j) += weights[j].value[k];
    for (std::size_t d = 0; d < depths.size(); ++d)
      {
        Eigen::MatrixXd  at_depth = Eigen::MatrixXd::Zero(s.n_nodes(), s.n_nodes());
        Eigen::Matrix3Xd position = Eigen::Matrix3Xd::Zero(3, s.n_nodes());
        for (Eigen::Index k = 0; k < plane_weights[d].size(); ++k)
          {
            at_depth += plane_weights[d][k] * far_field.by_depth[k];
            position += plane_weights[d][k] * far_field.depth_positions[k];
          }
        const Eigen::MatrixXd response = at_depth * load;
        for (std::size_t j = 0; j < patches.size(); ++j)
          {
            const FlankFrame frame = helicoid.frame(patches[j].roll, patches[j].z);
            Eigen::Matrix3d  axes;
            axes << frame.profile, frame.generator, frame.inward;
            for (std::size_t i = 0; i < patches.size(); ++i)
              if (patches[i].tooth == patches[j].tooth)
                {
                  double          elements = 0;
                  Eigen::Vector3d q        = Eigen::Vector3d::Zero();
                  for (std::size_t k = 0; k < weights[i].value.size(); ++k)
                    {
                      const int node = s.node(weights[i].row_node[k], weights[i].layer_node[k]);
                      elements += weights[i].value[k] * response(node, j);
                      q += weights[i].value[k] * position.col(node);
                    }
                  Eigen::Vector3d local = axes.transpose() * (q - frame.origin);
                  local.z()             = std::max(local.z(), 1e-6);
                  const double near = half_space::love_displacement(patches[j].half_profile, patches[j].half_generator, local, e, nu).z();
                  c(i, j) += extrapolate[d] * (elements - near);
                }
          }
      }
    for (std::size_t j = 0; j < patches.size(); ++j)
      for (std::size_t i = 0; i < patches.size(); ++i)
        if (patches[i].tooth == patches[j].tooth)
          {
            const Eigen::Vector2d d = patches[i].seen_from(patches[j], helicoid);
            c(i, j) += scale * half_space::mean_love_potential({ 0, 0, patches[j].half_profile, patches[j].half_generator },
                                                               { d.x(), d.y(), patches[i].half_profile, patches[i].half_generator });
          }
  }
} // namespace flank
