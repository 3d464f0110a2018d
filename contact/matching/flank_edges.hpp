// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/face_ends.hpp"
#include "contact/flanks/patch.hpp"
#include "contact/matching/tangent_half_space.hpp"
#include "contact/wedge/edge_field_on_demand.hpp"
#include "contact/wedge/face_table.hpp"

#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

namespace flank
{
  /// Edges of a flank that count as edges of elastic wedges.
  enum class FlankEdge
  {
    low,  ///< the face end at z = -b/2
    high, ///< the one at z = b/2
    tip   ///< the sharp tip
  };

  constexpr FlankEdge edge_at(const FlankEnd end)
  {
    return end == FlankEnd::low ? FlankEdge::low : FlankEdge::high;
  }

  /// Those that the field of a load leaves free: one end at most, and the tip.
  struct FreeEdges
  {
    FlankEnd end = FlankEnd::none;
    bool tip = false;

    bool operator==(const FreeEdges &) const = default;

    /// Calls use(FlankEdge) for each.
    template <class Use>
    void each(const Use &use) const
    {
      if (end != FlankEnd::none)
        use(edge_at(end));
      if (tip)
        use(FlankEdge::tip);
    }
  };

  /// The face ends of a gear as its flank's patches see them, and its sharp tip edge: elastic wedges whose
  /// edges are the ends' profiles (opening_at()) and the tip edge (opening_at_tip()), which a helical gear's
  /// generators meet at an angle. Safe for several threads.
  class FlankEdges
  {
  public:
    using Faces = std::vector<wedge::FaceTable>; ///< of both ends, then of the tip where it is one of them

    /// `free`: false: ends and tip count as half-space, whose tractions on them the elements take off.
    /// `known`: the tables of the faces if they are there already; else they are made when first asked for.
    explicit FlankEdges(const Gear &gear, bool free = true, const Faces *known = nullptr);

    /// Layers of elements, inclusive.
    struct Layers
    {
      int first, last;
    };

    /// The edges whose wedges are the field of loads on some elements, with a block of elements about them,
    /// of a flank of `count` layers: the end that the block reaches, of both the nearer one; none where it
    /// reaches none, or the loads lie in the middle. The tip for loads in the row beside it: a row away
    /// elements see as much.
    FreeEdges edges_of(const Layers &block, const Layers &loaded, int first_loaded_row, int count) const;

    bool are_free() const { return free_; }
    bool has_tip() const { return edges_.size() > 2; }
    double poissons_ratio() const { return poissons_ratio_; }

    /// A place of the flank.
    struct Place
    {
      double roll, z; ///< [rad], [mm]
    };

    /// Distance of a place from an edge: along its generator from an end, square to the tip; beyond it next
    /// to none. [mm]
    double distance(FlankEdge edge, const Place &place) const;

    /// That of a place a step (along the profile, along the generator) away; below 0 beyond the edge. [mm]
    double distance(FlankEdge edge, const Place &place, const Eigen::Vector2d &step) const
    {
      return distance(edge, place) + axes_of(edge).row(1).head<2>().dot(step);
    }

    /// A place that stands for a part of a patch, and where it lies from its middle along profile and
    /// generator. [mm]
    struct PartOfPatch
    {
      Eigen::Vector2d from_middle;
      Place place;
    };

    /// Equal parts of a patch for fields of these edges: two along the profile and along the generator each,
    /// where one of the edges is nearer than four half-lengths.
    std::vector<PartOfPatch> parts_of(const FreeEdges &edges, const Patch &patch) const;

    /// Boussinesq's displacement below a unit force together with what free edges add, at a place in the
    /// axes of the half-space below the force, whose own place on the flank is given. [mm/N]
    Eigen::Vector3d displacement(const FreeEdges &edges, const Place &force,
                                 const Eigen::Vector3d &relative) const;

    /// The displacement that a free edge adds there to Boussinesq's, in the same axes. [mm/N]
    Eigen::Vector3d added_displacement(FlankEdge edge, const Place &force,
                                       const Eigen::Vector3d &relative) const;

    /// The stress that a free edge adds there (tension positive), in the same axes. [1/mm^2]
    Eigen::Matrix3d added_stress(FlankEdge edge, const Place &force, const Eigen::Vector3d &relative) const;

    /// The angle that the body fills below an edge. [rad]
    double opening(FlankEdge edge) const { return edges_[static_cast<std::size_t>(edge)]->opening; }

    /// What a free edge adds on the flank.
    const wedge::FaceTable &face(FlankEdge edge) const;

    /// The strip of a patch, between its distances from an edge. [mm]
    wedge::Strip strip(FlankEdge edge, const Patch &patch) const;

    /// What a step (along the profile, along the generator) is along an edge. [mm]
    double along(FlankEdge edge, const Eigen::Vector2d &step) const;

    /// Half of a patch's length along an edge. [mm]
    double half_along(FlankEdge edge, const Patch &patch) const
    {
      return edge == FlankEdge::tip ? patch.half_generator * skew_ : patch.half_profile;
    }

    /// How much nearer to the tip a generator comes over a length of it. [mm]
    double nearer_along(const double length) const { return std::abs(tip_slope_) * length / skew_; }

    Faces faces() const;

  private:
    const wedge::EdgeField &field(FlankEdge edge) const;
    Eigen::Matrix3d axes_of(FlankEdge edge) const;

    bool free_;
    double youngs_modulus_, poissons_ratio_, base_helix_angle_, half_width_, base_radius_, tip_roll_,
        roll_per_generator_, ///< [rad/mm]
        tip_slope_,          ///< how much nearer the tip edge comes along the generator: that of the profile
        skew_;               ///< length of a piece of the tip edge over that of its generator
    struct Edge
    {
      double opening = 0; ///< [rad]
      std::shared_ptr<wedge::EdgeFieldOnDemand> field;
      std::once_flag face_once;
      wedge::FaceTable face;
    };
    mutable std::vector<std::unique_ptr<Edge>> edges_;
  };
} // namespace flank
