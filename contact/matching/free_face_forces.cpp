// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/free_face_forces.hpp"

#include "contact/half_space/half_space.hpp"

namespace flank
{
  FreeFaceForces::FreeFaceForces(const FlankBlock &block, const LagrangePolynomials &polynomials,
                                 const int points)
      : block_(block)
      , polynomials_(polynomials)
      , n_(polynomials.size())
      , close_(gauss(points - 1))
      , far_(gauss(std::max(2, points - 3)))
  {
  }

  void FreeFaceForces::add(const TangentHalfSpace &below, const SourceField &field,
                           Eigen::Ref<Eigen::VectorXd> force)
  {
    OfNodes sum;
    for (const FlankBlock::Face &face : block_.faces)
      {
        for (int k = 0; k < n_ * n_; ++k)
          nodes_[k] = below.relative(face.positions[k]);
        sum.fill(Eigen::Vector3d::Zero());
        const bool is_free_end = face.end != 0 && face.end == sign_of(field.free.end);
        const auto added = [&](const FlankEdge edge) {
          return [&field, edge](const Eigen::Vector3d &x) {
            return field.edges.added_stress(edge, field.force, x);
          };
        };
        // On the tip land both parts of the tip's wedge all but cancel: the flank before it is curved.
        if (!is_free_end)
          integrate(
              face.outward, 0,
              [&](const Eigen::Vector3d &x) {
                Eigen::Matrix3d stress = half_space::boussinesq_stress(x, field.edges.poissons_ratio());
                if (field.free.tip)
                  stress += field.edges.added_stress(FlankEdge::tip, field.force, x);
                return stress;
              },
              sum);
        // What a free end adds is smooth up to the load: its source lies beyond the end. So is what the tip
        // adds on an end.
        const auto beyond = [&](const FlankEdge edge) { return field.edges.distance(edge, field.force); };
        if (is_free_end && field.free.tip)
          integrate(face.outward, beyond(FlankEdge::tip), added(FlankEdge::tip), sum);
        if (!is_free_end && field.free.end != FlankEnd::none)
          {
            const FlankEdge end = edge_at(field.free.end);
            integrate(face.outward, beyond(end), added(end), sum);
          }
        for (int k = 0; k < n_ * n_; ++k)
          if (face.nodes[k] >= 0)
            force.segment<3>(3 * face.nodes[k]) += below.axes() * sum[k];
      }
  }

  FreeFaceForces::Line FreeFaceForces::line(const Shapes &second) const
  {
    Line result;
    for (int a = 0; a < n_; ++a)
      {
        result.x[a] = result.d2[a] = Eigen::Vector3d::Zero();
        for (int b = 0; b < n_; ++b)
          {
            result.x[a] += second.value[b] * nodes_[b * n_ + a];
            result.d2[a] += second.derivative[b] * nodes_[b * n_ + a];
          }
      }
    return result;
  }

  FreeFaceForces::Point FreeFaceForces::point(const Shapes &first, const Line &line) const
  {
    Point result;
    for (int a = 0; a < n_; ++a)
      {
        result.x += first.value[a] * line.x[a];
        result.d1 += first.derivative[a] * line.x[a];
        result.d2 += first.value[a] * line.d2[a];
      }
    return result;
  }

  template <class Stress>
  void FreeFaceForces::integrate(const double outward, const double beyond, const Stress &stress,
                                 OfNodes &sum)
  {
    // Parts about a load on the face's edge end at 2e-5 of the face, whatever the gear's size.
    const Point centre = point(polynomials_.with_derivatives(0.5), line(polynomials_.with_derivatives(0.5)));
    const double least = 2e-5 * std::max(centre.d1.norm(), centre.d2.norm());
    parts_.push_back({ 0, 1, 0, 1 });
    while (!parts_.empty())
      {
        const Part part = parts_.back();
        parts_.pop_back();
        const Point middle = point(polynomials_.with_derivatives(part.low1 + part.size1 / 2),
                                   line(polynomials_.with_derivatives(part.low2 + part.size2 / 2)));
        const double length1 = middle.d1.norm() * part.size1, length2 = middle.d2.norm() * part.size2,
                     longest = std::max(length1, length2),
                     distance = TangentHalfSpace::inside(middle.x).norm() + beyond;
        if (longest > 1.2 * distance && longest > least)
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
            parts_.push_back(first);
            parts_.push_back(second);
          }
        else
          integrate(stress, part, longest < 0.3 * distance ? far_ : close_, outward, sum);
      }
  }

  template <class Stress>
  void FreeFaceForces::integrate(const Stress &stress, const Part &part, const GaussRule &rule,
                                 const double outward, OfNodes &sum) const
  {
    const std::size_t n = rule.point.size();
    std::array<Shapes, 8> first;
    for (std::size_t q = 0; q < n; ++q)
      first[q] = polynomials_.with_derivatives(part.low1 + part.size1 * rule.point[q]);
    for (std::size_t q2 = 0; q2 < n; ++q2)
      {
        const Shapes second = polynomials_.with_derivatives(part.low2 + part.size2 * rule.point[q2]);
        const Line along = line(second);
        std::array<Eigen::Vector3d, max_points> of_line;
        of_line.fill(Eigen::Vector3d::Zero());
        for (std::size_t q1 = 0; q1 < n; ++q1)
          {
            const Point at = point(first[q1], along);
            const Eigen::Vector3d area =
                outward * rule.weight[q1] * rule.weight[q2] * part.size1 * part.size2 * at.d1.cross(at.d2);
            const Eigen::Vector3d traction = stress(TangentHalfSpace::inside(at.x)) * area;
            for (int a = 0; a < n_; ++a)
              of_line[a] += first[q1].value[a] * traction;
          }
        for (int b = 0; b < n_; ++b)
          for (int a = 0; a < n_; ++a)
            sum[b * n_ + a] += second.value[b] * of_line[a];
      }
  }
} // namespace flank
