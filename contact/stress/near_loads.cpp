// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/stress/near_loads.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/matching/patch_weights.hpp"

#include <algorithm>
#include <cmath>

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
                   .parts = {} };
    if (edges_)
      {
        const FlankEdges::Layers loaded{ first_layer, last_layer }; // a layer away elements see as much
        source.free = edges_->edges_of(loaded, loaded, first_row, surface_.layers);
        source.parts = edges_->parts_of(source.free, patch);
      }
    sources_.push_back(std::move(source));
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
    Field of_parts;
    const double share = 1.0 / static_cast<double>(source.parts.size());
    for (const auto &[from_middle, place] : source.parts)
      {
        const Eigen::Vector3d x(relative.x() - from_middle.x(), relative.y() - from_middle.y(), relative.z());
        of_parts.displacement += share * edges_->added_displacement(edge, place, x);
        of_parts.stress += share * edges_->added_stress(edge, place, x);
      }
    add_rotated(source, of_parts, sum);
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
