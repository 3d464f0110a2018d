// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/stress/near_loads.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/matching/patch_weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  NearLoads::NearLoads(const Gear &gear, const FlankSurface &surface, const FlankEdges *edges)
      : gear_(gear)
      , surface_(surface)
      , edges_(edges)
      , loaded_(static_cast<std::size_t>(surface.rows) * surface.layers, 0)
  {
  }

  void NearLoads::add(const Patch &patch, const double force)
  {
    const PatchWeights weights(surface_, { patch });
    const PatchWeights::Extent &w = weights.extent(0);
    const auto element = [](const double at, const int count) {
      return std::clamp(static_cast<int>(std::floor(at)), 0, count - 1);
    };
    const int first_row = element(w.row_low, surface_.rows), last_row = element(w.row_high, surface_.rows),
              first_layer = element(w.layer_low, surface_.layers),
              last_layer = element(w.layer_high, surface_.layers);
    for (int layer = first_layer; layer <= last_layer; ++layer)
      for (int row = first_row; row <= last_row; ++row)
        loaded_[static_cast<std::size_t>(layer * surface_.rows + row)] = 1;
    Source source{ .below = TangentHalfSpace(gear_.flank().frame(patch.roll, patch.z)),
                   .half_profile = patch.half_profile,
                   .half_generator = patch.half_generator,
                   .force = force,
                   .free = {},
                   .places = {},
                   .points = {} };
    if (edges_)
      {
        const FlankEdges::Layers loaded{ first_layer, last_layer }; // a layer away elements see as much
        source.free = edges_->edges_of(loaded, loaded, first_row, surface_.layers);
        set_points(patch, source);
      }
    sources_.push_back(std::move(source));
  }

  /// Two points along the profile and along the generator, where an edge is nearer than four half-lengths.
  void NearLoads::set_points(const Patch &patch, Source &source) const
  {
    const InvoluteHelicoid flank = gear_.flank();
    const FlankEdges::Place middle{ patch.roll, patch.z };
    double distance = std::numeric_limits<double>::max();
    source.free.each(
        [&](const FlankEdge edge) { distance = std::min(distance, edges_->distance(edge, middle)); });
    // The tip edge crosses the cells of helical gears: their middles alone where a point would lie beyond.
    const bool crosses =
        source.free.tip && patch.half_profile + edges_->nearer_along(patch.half_generator) >
                               0.9 * std::sqrt(3.0) * edges_->distance(FlankEdge::tip, middle);
    const auto offsets = [&](const double half) -> std::vector<double> {
      if (crosses || half < 0.25 * distance)
        return { 0.0 };
      return { -half / std::sqrt(3.0), half / std::sqrt(3.0) };
    };
    for (const double x : offsets(patch.half_profile))
      for (const double y : offsets(patch.half_generator))
        {
          source.points.emplace_back(x, y);
          source.places.push_back(
              { patch.roll + x / (gear_.base_radius * patch.roll) + y * flank.roll_per_generator(),
                patch.z + y * flank.cos_base_helix() });
        }
  }

  void NearLoads::add_rotated(const Source &source, const Field &field, Field &sum)
  {
    const Eigen::Matrix3d &axes = source.below.axes();
    sum.displacement += axes * (source.force * field.displacement);
    sum.stress += axes * (source.force * field.stress) * axes.transpose();
  }

  /// Love's formulas nearby, Boussinesq's beyond.
  void NearLoads::add_half_space(const Source &source, const Eigen::Vector3d &relative, Field &sum) const
  {
    const double a = source.half_profile, b = source.half_generator, near = 6 * std::max(a, b),
                 modulus = gear_.youngs_modulus, nu = gear_.poissons_ratio;
    const bool is_close = relative.squaredNorm() < near * near;
    add_rotated(source,
                is_close ? Field{ half_space::love_displacement(a, b, relative, modulus, nu),
                                  half_space::love_stress(a, b, relative, nu) }
                         : Field{ half_space::boussinesq_displacement(relative, modulus, nu),
                                  half_space::boussinesq_stress(relative, nu) },
                sum);
  }

  void NearLoads::add_edge(const Source &source, const FlankEdge edge, const Eigen::Vector3d &relative,
                           Field &sum) const
  {
    Field of_points;
    const double share = 1.0 / static_cast<double>(source.points.size());
    for (std::size_t k = 0; k < source.points.size(); ++k)
      {
        const Eigen::Vector3d x(relative.x() - source.points[k].x(), relative.y() - source.points[k].y(),
                                relative.z());
        of_points.displacement += share * edges_->added_displacement(edge, source.places[k], x);
        of_points.stress += share * edges_->added_stress(edge, source.places[k], x);
      }
    add_rotated(source, of_points, sum);
  }

  NearLoads::Field NearLoads::at(const Eigen::Vector3d &point) const
  {
    Field sum;
    for (const Source &source : sources_)
      {
        const Eigen::Vector3d x = TangentHalfSpace::inside(source.below.relative(point));
        add_half_space(source, x, sum);
        source.free.each([&](const FlankEdge edge) { add_edge(source, edge, x, sum); });
      }
    return sum;
  }

  Eigen::Matrix3d NearLoads::stress_on(const FlankEnd end, const Eigen::Vector3d &point) const
  {
    Field sum;
    for (const Source &source : sources_)
      {
        const Eigen::Vector3d x = TangentHalfSpace::inside(source.below.relative(point));
        const bool leaves_free = end != FlankEnd::none && source.free.end == end;
        if (!leaves_free)
          add_half_space(source, x, sum);
        source.free.each([&](const FlankEdge edge) {
          if (!leaves_free || edge != edge_at(end))
            add_edge(source, edge, x, sum);
        });
      }
    return sum.stress;
  }

  std::map<int, NearLoads> near_loads(const Gear &gear, const FlankSurface &surface, const FlankEdges *edges,
                                      const PositionResult &result, const Side side)
  {
    std::map<int, NearLoads> loads;
    each_loaded_patch(result, side, [&](const Patch &patch, const double force) {
      loads.try_emplace(patch.tooth, gear, surface, edges).first->second.add(patch, force);
    });
    return loads;
  }
} // namespace flank
