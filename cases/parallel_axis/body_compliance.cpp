// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/body_compliance.hpp"

#include "contact/half_space/half_space.hpp"
#include "mesh/base/errors.hpp"

#include <array>
#include <cmath>

namespace flank
{
  namespace
  {
    struct Rule
    {
      std::vector<double> point, weight; ///< on [0,1]
    };

    const Rule &gauss(const int n)
    {
      static const std::array<Rule, 6> rules{{{},
                                              {{0.5}, {1}},
                                              {{0.21132486540518712, 0.7886751345948129}, {0.5, 0.5}},
                                              {{0.1127016653792583, 0.5, 0.8872983346207417}, {5.0 / 18, 8.0 / 18, 5.0 / 18}},
                                              {{0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970262},
                                               {0.17392742256872692, 0.32607257743127307, 0.32607257743127307, 0.17392742256872692}},
                                              {{0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415, 0.953089922969332},
                                               {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454}}}};
      return rules[n];
    }

    using Polygon = std::vector<Eigen::Vector2d>;

    /// Part of a convex polygon with sign * (coordinate - limit) >= 0.
    Polygon clip(const Polygon &polygon, const int coordinate, const double limit, const double sign)
    {
      Polygon result;
      for (std::size_t i = 0; i < polygon.size(); ++i)
        {
          const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
          const double           da = sign * (a[coordinate] - limit), db = sign * (b[coordinate] - limit);
          if (da >= 0)
            result.push_back(a);
          if ((da > 0 && db < 0) || (da < 0 && db > 0))
            result.push_back(a + da / (da - db) * (b - a));
        }
      return result;
    }
  } // namespace

  struct BodyCompliance::Weighted
  {
    std::vector<int>    row_node, layer_node;
    std::vector<double> value;
    double              row_low, row_high, layer_low, layer_high; ///< extent in element coordinates
  };

  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution, const int max_offset, const Split split, const ClassicalDepth depth)
    : gear_(gear)
    , helicoid_(gear.flank())
    , split_(split)
    , depth_(depth)
    , sector_(make_tooth_sector(gear, resolution))
    , body_(sector_.mesh, resolution.degree, gear.youngs_modulus, gear.poissons_ratio)
    , far_field_(ring_compliance(sector_, body_, max_offset, split == Split::projected ? 0 : resolution.degree * (depth == ClassicalDepth::half_element ? 1 : 2)))
  {
    if (split == Split::projected)
      blocks_.emplace(sector_, body_);
  }

  BodyCompliance::Weighted BodyCompliance::weigh(const Patch &patch) const
  {
    const FlankSurface &s = far_field_.surface;
    Polygon             polygon;
    for (const Eigen::Vector2d &corner : patch.outline)
      polygon.emplace_back(std::clamp(s.row_coordinate(corner[0]), 0.0, static_cast<double>(s.rows)), std::clamp(s.layer_coordinate(corner[1]), 0.0, static_cast<double>(s.layers)));
    Weighted w;
    w.row_low = w.layer_low = 1e300;
    w.row_high = w.layer_high = -1e300;
    for (const Eigen::Vector2d &corner : polygon)
      {
        w.row_low    = std::min(w.row_low, corner[0]);
        w.row_high   = std::max(w.row_high, corner[0]);
        w.layer_low  = std::min(w.layer_low, corner[1]);
        w.layer_high = std::max(w.layer_high, corner[1]);
      }
    const int   p = s.degree, n = p + 1, row_begin = std::min(static_cast<int>(w.row_low), s.rows - 1), row_end = std::min(static_cast<int>(w.row_high), s.rows - 1);
    const int   layer_begin = std::min(static_cast<int>(w.layer_low), s.layers - 1), layer_end = std::min(static_cast<int>(w.layer_high), s.layers - 1);
    const int   row_nodes = (row_end - row_begin + 1) * p + 1, layer_nodes = (layer_end - layer_begin + 1) * p + 1;
    std::vector<double> value(static_cast<std::size_t>(row_nodes) * layer_nodes, 0.0);
    const Rule &rule = gauss(p + 2);
    double      area = 0;
    std::array<double, 4> nr{}, nl{};
    for (int layer = layer_begin; layer <= layer_end; ++layer)
      {
        const Polygon strip = clip(clip(polygon, 1, layer, 1), 1, layer + 1, -1);
        for (int row = row_begin; row <= row_end; ++row)
          {
            const Polygon part = clip(clip(strip, 0, row, 1), 0, row + 1, -1);
            for (std::size_t t = 2; t < part.size(); ++t)
              {
                const Eigen::Vector2d a = part[t - 1] - part[0], b = part[t] - part[0];
                const double          twice = std::abs(a[0] * b[1] - a[1] * b[0]);
                for (std::size_t i = 0; i < rule.point.size(); ++i) // collapsed square: from the first corner outwards
                  for (std::size_t j = 0; j < rule.point.size(); ++j)
                    {
                      const double          u = rule.point[i], v = rule.point[j], weight = rule.weight[i] * rule.weight[j] * u * twice;
                      const Eigen::Vector2d x = part[0] + u * ((1 - v) * a + v * b);
                      lagrange(s.abscissas, x[0] - row, nr.data());
                      lagrange(s.abscissas, x[1] - layer, nl.data());
                      area += weight;
                      for (int k = 0; k < n; ++k)
                        for (int r = 0; r < n; ++r)
                          value[((layer - layer_begin) * p + k) * row_nodes + (row - row_begin) * p + r] += weight * nr[r] * nl[k];
                    }
              }
          }
      }
    FLANK_ASSERT(area > 0, "a patch lies on the flank");
    for (int k = 0; k < layer_nodes; ++k)
      for (int r = 0; r < row_nodes; ++r)
        if (const double v = value[k * row_nodes + r] / area; v != 0)
          {
            w.row_node.push_back(row_begin * p + r);
            w.layer_node.push_back(layer_begin * p + k);
            w.value.push_back(v);
          }
    return w;
  }

  /// Nodal forces of the half-space tractions sigma(u_s).n on a block's true free faces. Each face is halved until a part is
  /// no longer than its distance from the patch, so that a touching edge is integrated as well as a far one.
  Eigen::VectorXd BodyCompliance::free_face_forces(const Patch &patch, const FlankBlock &block, const Eigen::Matrix3d &axes, const Eigen::Vector3d &origin,
                                                   const std::vector<Eigen::Vector4d> &points) const
  {
    const auto     &abscissas = far_field_.surface.abscissas;
    const int       n         = static_cast<int>(abscissas.size());
    const double    nu        = gear_.poissons_ratio, least_part = 0.5 * std::min(patch.half_profile, patch.half_generator);
    const double    extent    = std::max(patch.half_profile, patch.half_generator);
    Eigen::VectorXd force     = Eigen::VectorXd::Zero(block.face_response.cols());
    const Rule     &rule      = gauss(4);
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
        const auto local_point = [&] {
          Eigen::Vector3d local = axes.transpose() * (x - origin);
          local.z()             = std::max(0.0, local.z());
          return local;
        };
        stack.push_back({0, 1, 0, 1});
        while (!stack.empty())
          {
            const Part part = stack.back();
            stack.pop_back();
            evaluate(part.low1 + part.size1 / 2, part.low2 + part.size2 / 2);
            const Eigen::Vector3d middle   = local_point();
            const double          length1  = x1.norm() * part.size1, length2 = x2.norm() * part.size2, longest = std::max(length1, length2);
            const double          distance = std::hypot(std::max(0.0, std::abs(middle.x()) - patch.half_profile), std::max(0.0, std::abs(middle.y()) - patch.half_generator), middle.z());
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
            const bool close = distance - longest < 4 * extent;
            for (std::size_t q2 = 0; q2 < rule.point.size(); ++q2)
              for (std::size_t q1 = 0; q1 < rule.point.size(); ++q1)
                {
                  evaluate(part.low1 + part.size1 * rule.point[q1], part.low2 + part.size2 * rule.point[q2]);
                  const Eigen::Vector3d area   = face.outward * rule.weight[q1] * rule.weight[q2] * part.size1 * part.size2 * x1.cross(x2);
                  const Eigen::Vector3d local  = local_point();
                  Eigen::Matrix3d       stress = Eigen::Matrix3d::Zero();
                  if (close)
                    stress = half_space::love_stress(patch.half_profile, patch.half_generator, local, nu);
                  else
                    for (const Eigen::Vector4d &q : points)
                      stress += q[3] * half_space::boussinesq_stress(local - q.head<3>(), nu);
                  const Eigen::Vector3d traction = axes * (stress * (axes.transpose() * area));
                  for (int b = 0; b < n; ++b)
                    for (int a = 0; a < n; ++a)
                      if (face.nodes[b * n + a] >= 0)
                        force.segment<3>(3 * face.nodes[b * n + a]) += n1[a] * n2[b] * traction;
                }
          }
      }
    return force;
  }

  Eigen::VectorXd BodyCompliance::block_response(const Patch &patch, const Weighted &weight, const FlankBlock &block, const int layer_shift) const
  {
    const double     e = gear_.youngs_modulus, nu = gear_.poissons_ratio;
    const FlankFrame frame = helicoid_.frame(patch.roll, patch.z + layer_shift * sector_.layer_height());
    Eigen::Matrix3d  axes;
    axes << frame.profile, frame.generator, frame.inward;
    const auto to_local = [&](const Eigen::Vector3d &x) {
      Eigen::Vector3d local = axes.transpose() * (x - frame.origin);
      local.z()             = std::max(0.0, local.z());
      return local;
    };
    // Far points see the patch as a few point loads.
    const double       row_height = gear_.base_radius / 2 * (far_field_.surface.q_tip - far_field_.surface.q_form) / far_field_.surface.rows;
    const Rule        &along      = gauss(std::clamp(static_cast<int>(std::ceil(3 * patch.half_generator / row_height)) + 1, 2, 5));
    const Rule        &across     = gauss(std::clamp(static_cast<int>(std::ceil(4 * patch.half_profile / row_height)), 1, 5));
    std::vector<Eigen::Vector4d> points;
    for (std::size_t i = 0; i < across.point.size(); ++i)
      for (std::size_t j = 0; j < along.point.size(); ++j)
        points.emplace_back((2 * across.point[i] - 1) * patch.half_profile, (2 * along.point[j] - 1) * patch.half_generator, 0, across.weight[i] * along.weight[j]);

    Eigen::VectorXd cut(block.cut_positions.size());
    for (Eigen::Index c = 0; c < block.cut_positions.cols(); ++c)
      {
        const Eigen::Vector3d local = to_local(block.cut_positions.col(c));
        Eigen::Vector3d       u     = Eigen::Vector3d::Zero();
        for (const Eigen::Vector4d &q : points)
          u += q[3] * half_space::boussinesq_displacement(local - q.head<3>(), e, nu);
        cut.segment<3>(3 * c) = axes * u;
      }
    Eigen::VectorXd load = Eigen::VectorXd::Zero(block.load_response.cols());
    const int       p    = far_field_.surface.degree;
    for (std::size_t k = 0; k < weight.value.size(); ++k)
      load[block.node(weight.row_node[k] - block.first_row * p, weight.layer_node[k] + (layer_shift - block.first_layer) * p)] += weight.value[k];
    Eigen::VectorXd response = block.load_response * load;
    response.noalias() += block.cut_response * cut;

    if (!block.faces.empty())
      response.noalias() += block.face_response * free_face_forces(patch, block, axes, frame.origin, points);
    return response;
  }

  namespace
  {
    /// Position of patch i's centre in patch j's tangent frame: along the generator first, then along the profile arc.
    Eigen::Vector2d offset(const InvoluteHelicoid &helicoid, const Patch &i, const Patch &j)
    {
      const double y = (i.z - j.z) / helicoid.cos_base_helix(), roll = j.roll + y * helicoid.roll_per_generator();
      return {helicoid.base_radius() / 2 * (i.roll - roll) * (i.roll + roll), y};
    }
  } // namespace

  void BodyCompliance::add_projected(const std::vector<Patch> &patches, const std::vector<Weighted> &weights, Eigen::MatrixXd &c) const
  {
    const FlankSurface &s     = far_field_.surface;
    const double        scale = half_space::surface_compliance(gear_.youngs_modulus, gear_.poissons_ratio);
    const int           p     = s.degree;
    for (std::size_t j = 0; j < patches.size(); ++j)
      {
        // Loaded elements: those the patch reaches into by more than half an element, so the cut stays more than 1.5 away.
        const auto  range = [](const double low, const double high, const int count) {
          const double middle = 0.5 * (low + high), reach = std::max(0.0, 0.5 * (high - low) - 0.5);
          return std::pair{std::clamp(static_cast<int>(middle - reach), 0, count - 1), std::clamp(static_cast<int>(middle + reach), 0, count - 1)};
        };
        const Weighted &wj          = weights[j];
        const auto [row_a, row_b]     = range(wj.row_low, wj.row_high, s.rows);
        const auto [layer_a, layer_b] = range(wj.layer_low, wj.layer_high, s.layers);
        const auto [block, shift]     = blocks_->around(row_a, row_b, layer_a, layer_b);
        const Eigen::VectorXd response = block_response(patches[j], wj, *block, shift);
        const double row_end = std::min(block->last_row + 1, s.rows), layer_begin = block->first_layer - shift, layer_end = block->last_layer + 1 - shift;
        const half_space::Rectangle source{0, 0, patches[j].half_profile, patches[j].half_generator};
        for (std::size_t i = 0; i < patches.size(); ++i)
          {
            const Weighted &wi = weights[i];
            if (patches[i].tooth != patches[j].tooth || wi.row_low < block->first_row || wi.row_high > row_end || wi.layer_low < layer_begin || wi.layer_high > layer_end)
              continue;
            double elements = 0;
            for (std::size_t k = 0; k < wi.value.size(); ++k)
              elements += wi.value[k] * response[block->node(wi.row_node[k] - block->first_row * p, wi.layer_node[k] + (shift - block->first_layer) * p)];
            const Eigen::Vector2d d = offset(helicoid_, patches[i], patches[j]);
            c(i, j) += scale * half_space::mean_love_potential(source, {d.x(), d.y(), patches[i].half_profile, patches[i].half_generator}) - elements;
          }
      }
  }

  void BodyCompliance::add_classical(const std::vector<Patch> &patches, const std::vector<Weighted> &weights, Eigen::MatrixXd &c) const
  {
    // u = u_s(i) - u_s(q) + u_fe(q), on the same tooth; q below i at half an element, or the straight line through
    // the values at 0.75, 1, ..., 2 elements taken back to the surface.
    const FlankSurface &s     = far_field_.surface;
    const double        e = gear_.youngs_modulus, nu = gear_.poissons_ratio, scale = half_space::surface_compliance(e, nu);
    const int           p = s.degree, n_levels = depth_ == ClassicalDepth::half_element ? 1 : 2;
    std::vector<double> depths = depth_ == ClassicalDepth::half_element ? std::vector<double>{0.5} : std::vector<double>{0.75, 1, 1.25, 1.5, 1.75, 2};
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
            at_depth += plane_weights[d][k] * far_field_.by_depth[k];
            position += plane_weights[d][k] * far_field_.depth_positions[k];
          }
        const Eigen::MatrixXd response = at_depth * load;
        for (std::size_t j = 0; j < patches.size(); ++j)
          {
            const FlankFrame frame = helicoid_.frame(patches[j].roll, patches[j].z);
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
            const Eigen::Vector2d d = offset(helicoid_, patches[i], patches[j]);
            c(i, j) += scale * half_space::mean_love_potential({0, 0, patches[j].half_profile, patches[j].half_generator},
                                                               {d.x(), d.y(), patches[i].half_profile, patches[i].half_generator});
          }
  }

  double BodyCompliance::elements_alone(const Patch &patch) const
  {
    const FlankSurface &s      = far_field_.surface;
    const Weighted      weight = weigh(patch);
    Eigen::VectorXd     load   = Eigen::VectorXd::Zero(s.n_nodes());
    for (std::size_t k = 0; k < weight.value.size(); ++k)
      load[s.node(weight.row_node[k], weight.layer_node[k])] += weight.value[k];
    return load.dot(far_field_.by_tooth_offset[0] * load);
  }

  Eigen::MatrixXd BodyCompliance::between(const std::vector<Patch> &patches, double &asymmetry) const
  {
    const FlankSurface   &s = far_field_.surface;
    const auto            n = static_cast<Eigen::Index>(patches.size());
    std::vector<Weighted> weights;
    for (const Patch &patch : patches)
      weights.push_back(weigh(patch));

    // Far field: N_i C_h f_j with the tooth offset's operator, patches of one tooth at a time.
    Eigen::MatrixXd              c = Eigen::MatrixXd::Zero(n, n);
    std::map<int, std::vector<int>> of_tooth;
    for (Eigen::Index i = 0; i < n; ++i)
      of_tooth[patches[i].tooth].push_back(static_cast<int>(i));
    for (const auto &[load_tooth, loads] : of_tooth)
      for (const auto &[tooth, outputs] : of_tooth)
        {
          if (tooth == load_tooth && split_ == Split::classical)
            continue;
          if (tooth < load_tooth)
            continue; // reciprocity gives the other half
          const int teeth  = gear_.teeth;
          const int ahead  = ((tooth - load_tooth) % teeth + teeth) % teeth;
          const int offset = ahead <= teeth - ahead ? ahead : teeth - ahead;
          FLANK_ASSERT(offset <= max_offset(), std::to_string(offset));
          const Eigen::MatrixXd &h         = far_field_.by_tooth_offset[offset];
          const bool             transpose = ahead != offset;
          Eigen::MatrixXd        response(s.n_nodes(), loads.size());
          response.setZero();
          for (std::size_t j = 0; j < loads.size(); ++j)
            for (std::size_t k = 0; k < weights[loads[j]].value.size(); ++k)
              {
                const int node = s.node(weights[loads[j]].row_node[k], weights[loads[j]].layer_node[k]);
                if (transpose)
                  response.col(j) += weights[loads[j]].value[k] * h.row(node).transpose();
                else
                  response.col(j) += weights[loads[j]].value[k] * h.col(node);
              }
          for (const int i : outputs)
            for (std::size_t j = 0; j < loads.size(); ++j)
              {
                double sum = 0;
                for (std::size_t k = 0; k < weights[i].value.size(); ++k)
                  sum += weights[i].value[k] * response(s.node(weights[i].row_node[k], weights[i].layer_node[k]), j);
                c(i, loads[j]) += sum;
                if (tooth != load_tooth)
                  c(loads[j], i) += sum;
              }
        }
    if (split_ == Split::projected)
      add_projected(patches, weights, c);
    else
      add_classical(patches, weights, c);
    asymmetry = (c - c.transpose()).cwiseAbs().maxCoeff() / c.cwiseAbs().maxCoeff();
    return 0.5 * (c + c.transpose());
  }
} // namespace flank
