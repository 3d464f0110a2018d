// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/flank_edges.hpp"

#include "contact/flanks/tip_edges.hpp"
#include "contact/half_space/half_space.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/gear/tip_edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    FlankEnd end_of(const FlankEdge edge)
    {
      return edge == FlankEdge::low    ? FlankEnd::low
             : edge == FlankEdge::high ? FlankEnd::high
                                       : FlankEnd::none;
    }

    /// Which way the wedge's axis s, away from its edge, runs along the generator.
    double along_generator(const FlankEdge edge)
    {
      return -sign_of(end_of(edge));
    }
  } // namespace

  FlankEdges::FlankEdges(const Gear &gear, const bool free, const Faces *known)
      : free_(free)
      , youngs_modulus_(gear.youngs_modulus)
      , poissons_ratio_(gear.poissons_ratio)
      , base_helix_angle_(gear.base_helix_angle)
      , half_width_(gear.face_width / 2)
      , base_radius_(gear.base_radius)
      , tip_roll_(body_tip_roll(gear))
      , roll_per_generator_(gear.flank().roll_per_generator())
      , tip_slope_(gear.base_radius * tip_roll_ * roll_per_generator_)
      , skew_(std::hypot(1, tip_slope_))
  {
    std::vector<double> openings = { opening_at(gear, FlankEnd::low), opening_at(gear, FlankEnd::high) };
    if (gear.tip_rounding == 0)
      openings.push_back(opening_at_tip(gear));
    FLANK_ASSERT(!known || known->size() == openings.size(), "a face an edge");
    for (std::size_t k = 0; k < openings.size(); ++k)
      {
        Edge &edge = *edges_.emplace_back(std::make_unique<Edge>());
        edge.opening = openings[k];
        edge.field = wedge::edge_field_on_demand(openings[k], poissons_ratio_);
        if (known)
          std::call_once(edge.face_once, [&] { edge.face = (*known)[k]; });
      }
  }

  /// Rows: the wedge's axes in those of the half-space below a force: along the edge, away from it, inward.
  Eigen::Matrix3d FlankEdges::axes_of(const FlankEdge edge) const
  {
    Eigen::Matrix3d axes;
    if (edge == FlankEdge::tip)
      axes << -tip_slope_ / skew_, 1 / skew_, 0, -1 / skew_, -tip_slope_ / skew_, 0, 0, 0, 1;
    else
      axes << 1, 0, 0, 0, along_generator(edge), 0, 0, 0, 1;
    return axes;
  }

  FreeEdges FlankEdges::edges_of(const Layers &block, const Layers &loaded, const int first_loaded_row,
                                 const int count) const
  {
    FreeEdges result;
    if (!free_)
      return result;
    const int beyond_low = loaded.first, beyond_high = count - 1 - loaded.last;
    if (beyond_low < beyond_high && block.first == 0)
      result.end = FlankEnd::low;
    if (beyond_low > beyond_high && block.last == count - 1)
      result.end = FlankEnd::high;
    result.tip = has_tip() && first_loaded_row == 0;
    return result;
  }

  double FlankEdges::distance(const FlankEdge edge, const Place &place) const
  {
    const double least = 1e-9 * half_width_; // what a load at an edge adds has no limit
    if (edge == FlankEdge::tip)
      return std::max(least, profile_length(place.roll, tip_roll_, base_radius_) / skew_);
    return std::max(least, (half_width_ + along_generator(edge) * place.z) / std::cos(base_helix_angle_));
  }

  std::vector<FlankEdges::PartOfPatch> FlankEdges::parts_of(const FreeEdges &edges, const Patch &patch) const
  {
    const Place middle{ patch.roll, patch.z };
    double nearest = std::numeric_limits<double>::max();
    edges.each([&](const FlankEdge edge) { nearest = std::min(nearest, distance(edge, middle)); });
    // The tip edge crosses the cells of helical gears: their middles alone where a part would lie beyond.
    const bool crosses = edges.tip && patch.half_profile + nearer_along(patch.half_generator) >
                                          0.9 * std::sqrt(3.0) * distance(FlankEdge::tip, middle);
    const auto offsets = [&](const double half) -> std::vector<double> {
      if (crosses || half < 0.25 * nearest)
        return { 0.0 };
      return { -half / std::sqrt(3.0), half / std::sqrt(3.0) };
    };
    std::vector<PartOfPatch> parts;
    for (const double x : offsets(patch.half_profile))
      for (const double y : offsets(patch.half_generator))
        parts.push_back({ { x, y },
                          { patch.roll + x / (base_radius_ * patch.roll) + y * roll_per_generator_,
                            patch.z + y * std::cos(base_helix_angle_) } });
    return parts;
  }

  Eigen::Vector3d FlankEdges::displacement(const FreeEdges &edges, const Place &force,
                                           const Eigen::Vector3d &relative) const
  {
    Eigen::Vector3d result = half_space::boussinesq_displacement(relative, youngs_modulus_, poissons_ratio_);
    edges.each([&](const FlankEdge edge) { result += added_displacement(edge, force, relative); });
    return result;
  }

  Eigen::Vector3d FlankEdges::added_displacement(const FlankEdge edge, const Place &force,
                                                 const Eigen::Vector3d &relative) const
  {
    const Eigen::Matrix3d axes = axes_of(edge);
    const double d = distance(edge, force);
    return axes.transpose() * field(edge).displacement(axes * relative + d * Eigen::Vector3d::UnitY(), d) /
           youngs_modulus_;
  }

  Eigen::Matrix3d FlankEdges::added_stress(const FlankEdge edge, const Place &force,
                                           const Eigen::Vector3d &relative) const
  {
    const Eigen::Matrix3d axes = axes_of(edge);
    const double d = distance(edge, force), nu = poissons_ratio_;
    const Eigen::Matrix3d gradient = field(edge).gradient(axes * relative + d * Eigen::Vector3d::UnitY(), d),
                          strain = 0.5 * (gradient + gradient.transpose()),
                          stress =
                              (strain + nu / (1 - 2 * nu) * strain.trace() * Eigen::Matrix3d::Identity()) /
                              (1 + nu);
    return axes.transpose() * stress * axes;
  }

  const wedge::EdgeField &FlankEdges::field(const FlankEdge edge) const
  {
    return edges_[static_cast<std::size_t>(edge)]->field->field();
  }

  const wedge::FaceTable &FlankEdges::face(const FlankEdge edge) const
  {
    Edge &of_edge = *edges_[static_cast<std::size_t>(edge)];
    std::call_once(of_edge.face_once, [&] { of_edge.face = field(edge).face(); });
    return of_edge.face;
  }

  FlankEdges::Faces FlankEdges::faces() const
  {
    Faces result = { face(FlankEdge::low), face(FlankEdge::high) };
    if (has_tip())
      result.push_back(face(FlankEdge::tip));
    return result;
  }

  double FlankEdges::along(const FlankEdge edge, const Eigen::Vector2d &step) const
  {
    return edge == FlankEdge::tip ? (step.y() - tip_slope_ * step.x()) / skew_ : step.x();
  }

  wedge::Strip FlankEdges::strip(const FlankEdge edge, const Patch &patch) const
  {
    // The cells of a slice lie on one strip, but for rounding.
    const bool at_tip = edge == FlankEdge::tip;
    const double rounding = 1e-11 * half_width_,
                 middle = at_tip
                              ? profile_length(patch.roll, tip_roll_, base_radius_) / skew_
                              : (half_width_ + along_generator(edge) * patch.z) / std::cos(base_helix_angle_),
                 half = at_tip ? patch.half_profile / skew_ : patch.half_generator;
    const auto rounded = [&](const double at) { return std::max(0.0, rounding * std::round(at / rounding)); };
    return { rounded(middle - half), rounded(middle + half) };
  }
} // namespace flank
