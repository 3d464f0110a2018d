// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/face_ends.hpp"
#include "contact/matching/tangent_half_space.hpp"
#include "contact/wedge/edge_field_on_demand.hpp"
#include "contact/wedge/face_table.hpp"

#include <array>
#include <memory>
#include <mutex>

namespace flank
{
  /// The face ends of a gear as its flank's patches see them: elastic wedges whose edges are the ends'
  /// profiles (opening_at()). Safe for several threads.
  class FlankEnds
  {
  public:
    using Faces = std::array<wedge::FaceTable, 2>; ///< of both ends

    /// `free`: false: ends count as half-space, whose tractions on them the elements take off.
    /// `known`: the tables of both faces if they are there already; else they are made when first asked for.
    explicit FlankEnds(const Gear &gear, bool free = true, const Faces *known = nullptr);

    /// Layers of elements, inclusive.
    struct Layers
    {
      int first, last;
    };

    /// The end whose wedge is the field of loads on some layers of elements, with a block of elements about
    /// them, of a flank of `count` layers: the one that the block reaches, of both the nearer one; none where
    /// it reaches none, or the loads lie in the middle.
    FlankEnd end_of(const Layers &block, const Layers &loaded, const int count) const
    {
      const int beyond_low = loaded.first, beyond_high = count - 1 - loaded.last;
      if (!free_ || beyond_low == beyond_high)
        return FlankEnd::none;
      if (beyond_low < beyond_high)
        return block.first == 0 ? FlankEnd::low : FlankEnd::none;
      return block.last == count - 1 ? FlankEnd::high : FlankEnd::none;
    }

    bool are_free() const { return free_; }
    double poissons_ratio() const { return poissons_ratio_; }

    /// Distance of a place of the flank from an end, along its generator. [mm]
    double distance(FlankEnd end, double z) const;

    /// Boussinesq's displacement below a unit force together with what the free end adds, at a place in the
    /// axes of the half-space below the force, whose z on the flank is given. [mm/N]
    Eigen::Vector3d displacement(FlankEnd end, double z, const Eigen::Vector3d &relative) const;

    /// The stress that the free end adds there (tension positive), in the same axes. [1/mm^2]
    Eigen::Matrix3d added_stress(FlankEnd end, double z, const Eigen::Vector3d &relative) const;

    /// What the free end adds on the flank.
    const wedge::FaceTable &face(FlankEnd end) const;

    /// The strip of a patch, between its distances from an end: of a patch with its middle at z and of this
    /// half-length along the generator. [mm]
    wedge::Strip strip(FlankEnd end, double z, double half_generator) const;

    Faces faces() const { return { face(FlankEnd::low), face(FlankEnd::high) }; }

  private:
    const wedge::EdgeField &field(FlankEnd end) const;

    bool free_;
    double youngs_modulus_, poissons_ratio_, base_helix_angle_, half_width_;
    struct End
    {
      std::shared_ptr<wedge::EdgeFieldOnDemand> field;
      std::once_flag face_once;
      wedge::FaceTable face;
    };
    mutable std::array<End, 2> ends_;
  };
} // namespace flank
