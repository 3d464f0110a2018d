// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/projected_split.hpp"

#include "contact/half_space/half_space.hpp"
#include "mesh/base/gauss.hpp"

#include <array>
#include <cmath>

namespace flank
{
  ProjectedSplit::ProjectedSplit(const ToothSector &sector, const ElasticBody &body)
      : sector_(sector)
      , youngs_modulus_(sector.gear.youngs_modulus)
      , poissons_ratio_(sector.gear.poissons_ratio)
      , helicoid_(sector.gear.flank())
      , surface_(flank_surface(sector))
      , blocks_(sector, body)
  {
  }

  Eigen::Vector3d ProjectedSplit::HalfSpaceSource::local(const Eigen::Vector3d &x) const
  {
    Eigen::Vector3d result = axes.transpose() * (x - origin);
    result.z()             = std::max(0.0, result.z());
    return result;
  }

  ProjectedSplit::HalfSpaceSource ProjectedSplit::source(const Patch &patch, const int layer_shift) const
  {
    const FlankFrame frame = helicoid_.frame(patch.roll, patch.z + layer_shift * sector_.layer_height());
    HalfSpaceSource  result{ patch.half_profile, patch.half_generator, frame.origin, {}, {} };
    result.axes << frame.profile, frame.generator, frame.inward;
    // The cut is 1.5 elements away or more: a few point loads, as many as the patch is long against an element.
    const double     row_height = sector_.gear.base_radius / 2 * (surface_.q_tip - surface_.q_form) / surface_.rows;
    const GaussRule &along      = gauss(std::clamp(static_cast<int>(std::ceil(3 * patch.half_generator / row_height)) + 1, 2, 5));
    const GaussRule &across     = gauss(std::clamp(static_cast<int>(std::ceil(4 * patch.half_profile / row_height)), 1, 5));
    for (std::size_t i = 0; i < across.point.size(); ++i)
      for (std::size_t j = 0; j < along.point.size(); ++j)
        result.points.emplace_back((2 * across.point[i] - 1) * patch.half_profile, (2 * along.point[j] - 1) * patch.half_generator, 0,
                                   across.weight[i] * along.weight[j]);
    return result;
  }

  // Each face is halved until a part is no longer than its distance from the patch, so that a touching edge is integrated as well as a far
  // one.
  Eigen::VectorXd ProjectedSplit::free_face_forces(const HalfSpaceSource &field, const FlankBlock &block) const
  {
    const auto      &abscissas = surface_.abscissas;
    const int        n         = static_cast<int>(abscissas.size());
    const double     nu = poissons_ratio_, least_part = 0.5 * std::min(field.half_profile, field.half_generator);
    const double     extent = std::max(field.half_profile, field.half_generator);
    Eigen::VectorXd  force  = Eigen::VectorXd::Zero(block.face_response.cols());
    const GaussRule &rule   = gauss(4);
    struct Part
    {
      double low1, size1, low2, size2;
    };
    std::vector<Part>     stack;
    std::array<double, 4> n1{}, n2{}, d1{}, d2{}, before{}, after{};
    const auto            shapes = [&](const double t, std::array<double, 4> &value, std::array<double, 4> &derivative) {
      constexpr double h = 1e-5; // the fourth derivative of a cubic is zero: the difference is good to 1e-10
      lagrange(abscissas, t, value.data());
      lagrange(abscissas, t - h, before.data());
      lagrange(abscissas, t + h, after.data());
      for (int i = 0; i < n; ++i)
        derivative[i] = (after[i] - before[i]) / (2 * h);
    };
    for (const FlankBlock::Face &face : block.faces)
      {
        Eigen::Vector3d x, x1, x2;
        const auto      evaluate = [&](const double t1, const double t2) {
          shapes(t1, n1, d1);
          shapes(t2, n2, d2);
          x = x1 = x2 = Eigen::Vector3d::Zero();
          for (int b = 0; b < n; ++b)
            for (int a = 0; a < n; ++a)
              {
                const Eigen::Vector3d &node = face.positions[b * n + a];
                x += n1[a] * n2[b] * node;
                x1 += d1[a] * n2[b] * node;
                x2 += n1[a] * d2[b] * node;
              }
        };
        stack.push_back({ 0, 1, 0, 1 });
        while (!stack.empty())
          {
            const Part part = stack.back();
            stack.pop_back();
            evaluate(part.low1 + part.size1 / 2, part.low2 + part.size2 / 2);
            const Eigen::Vector3d middle  = field.local(x);
            const double          length1 = x1.norm() * part.size1, length2 = x2.norm() * part.size2, longest = std::max(length1, length2);
            const double          distance = std::hypot(std::max(0.0, std::abs(middle.x()) - field.half_profile),
                                                        std::max(0.0, std::abs(middle.y()) - field.half_generator), middle.z());
            if (longest > 1.2 * distance && longest > least_part)
              {
                Part first = part, second = part;
                if (length1 >= length2)
                  {
                    first.size1 = second.size1 = part.size1 / 2;
                    second.low1 += second.size1;
                  }
                else
                  {
                    first.size2 = second.size2 = part.size2 / 2;
                    second.low2 += second.size2;
                  }
                stack.push_back(first);
                stack.push_back(second);
                continue;
              }
            const bool close = distance - longest < 1.5 * extent; // farther off the point loads serve
            for (std::size_t q2 = 0; q2 < rule.point.size(); ++q2)
              for (std::size_t q1 = 0; q1 < rule.point.size(); ++q1)
                {
                  evaluate(part.low1 + part.size1 * rule.point[q1], part.low2 + part.size2 * rule.point[q2]);
                  const Eigen::Vector3d area   = face.outward * rule.weight[q1] * rule.weight[q2] * part.size1 * part.size2 * x1.cross(x2);
                  const Eigen::Vector3d local  = field.local(x);
                  Eigen::Matrix3d       stress = Eigen::Matrix3d::Zero();
                  if (close)
                    stress = half_space::love_stress(field.half_profile, field.half_generator, local, nu);
                  else
                    for (const Eigen::Vector4d &q : field.points)
                      stress += q[3] * half_space::boussinesq_stress(local - q.head<3>(), nu);
                  const Eigen::Vector3d traction = field.axes * (stress * (field.axes.transpose() * area));
                  for (int b = 0; b < n; ++b)
                    for (int a = 0; a < n; ++a)
                      if (face.nodes[b * n + a] >= 0)
                        force.segment<3>(3 * face.nodes[b * n + a]) += n1[a] * n2[b] * traction;
                }
          }
      }
    return force;
  }

  Eigen::VectorXd ProjectedSplit::block_response(const Patch &patch, const PatchWeights &weights, const FlankBlock &block,
                                                 const int layer_shift) const
  {
    const HalfSpaceSource field = source(patch, layer_shift);
    Eigen::VectorXd       cut(block.cut_positions.size());
    for (Eigen::Index c = 0; c < block.cut_positions.cols(); ++c)
      {
        const Eigen::Vector3d local = field.local(block.cut_positions.col(c));
        Eigen::Vector3d       u     = Eigen::Vector3d::Zero();
        for (const Eigen::Vector4d &q : field.points)
          u += q[3] * half_space::boussinesq_displacement(local - q.head<3>(), youngs_modulus_, poissons_ratio_);
        cut.segment<3>(3 * c) = field.axes * u;
      }
    Eigen::VectorXd load = Eigen::VectorXd::Zero(block.load_response.cols());
    const int       p    = surface_.degree;
    for (std::size_t k = 0; k < weights.value.size(); ++k)
      load[block.node(weights.row_node[k] - block.first_row * p, weights.layer_node[k] + (layer_shift - block.first_layer) * p)] +=
          weights.value[k];
    Eigen::VectorXd response = block.load_response * load;
    response.noalias() += block.cut_response * cut;
    if (!block.faces.empty())
      response.noalias() += block.face_response * free_face_forces(field, block);
    return response;
  }

  void ProjectedSplit::add(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, Eigen::MatrixXd &c) const
  {
    const FlankSurface &s     = surface_;
    const double        scale = half_space::surface_compliance(youngs_modulus_, poissons_ratio_);
    const int           p     = s.degree;
    for (std::size_t j = 0; j < patches.size(); ++j)
      {
        // Loaded elements: those the patch reaches into by more than half an element, so the cut stays more than 1.5 away.
        const auto range = [](const double low, const double high, const int count) {
          const double middle = 0.5 * (low + high), reach = std::max(0.0, 0.5 * (high - low) - 0.5);
          return std::pair{ std::clamp(static_cast<int>(middle - reach), 0, count - 1),
                            std::clamp(static_cast<int>(middle + reach), 0, count - 1) };
        };
        const PatchWeights &wj         = weights[j];
        const auto [row_a, row_b]      = range(wj.row_low, wj.row_high, s.rows);
        const auto [layer_a, layer_b]  = range(wj.layer_low, wj.layer_high, s.layers);
        const auto [block, shift]      = blocks_.around(row_a, row_b, layer_a, layer_b);
        const Eigen::VectorXd response = block_response(patches[j], wj, *block, shift);
        const double          row_end = std::min(block->last_row + 1, s.rows), layer_begin = block->first_layer - shift,
                     layer_end = block->last_layer + 1 - shift;
        const half_space::Rectangle source{ 0, 0, patches[j].half_profile, patches[j].half_generator };
        for (std::size_t i = 0; i < patches.size(); ++i)
          {
            const PatchWeights &wi = weights[i];
            if (patches[i].tooth != patches[j].tooth || wi.row_low < block->first_row || wi.row_high > row_end ||
                wi.layer_low < layer_begin || wi.layer_high > layer_end)
              continue;
            double elements = 0;
            for (std::size_t k = 0; k < wi.value.size(); ++k)
              elements += wi.value[k] *
                          response[block->node(wi.row_node[k] - block->first_row * p, wi.layer_node[k] + (shift - block->first_layer) * p)];
            const Eigen::Vector2d d = patches[i].seen_from(patches[j], helicoid_);
            c(i, j) +=
                scale * half_space::mean_love_potential(source, { d.x(), d.y(), patches[i].half_profile, patches[i].half_generator }) -
                elements;
          }
      }
  }
} // namespace flank
