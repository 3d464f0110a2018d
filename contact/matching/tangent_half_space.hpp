// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/involute.hpp"

#include <algorithm>

namespace flank
{
  /// The half-space that touches a flank at a point: its surface is the tangent plane there, its axes are
  /// profile, generator, inward.
  class TangentHalfSpace
  {
  public:
    explicit TangentHalfSpace(const FlankFrame &frame)
        : origin_(frame.origin)
    {
      axes_ << frame.profile, frame.generator, frame.inward;
    }

    /// A place of the body in the half-space's axes. [mm]
    Eigen::Vector3d relative(const Eigen::Vector3d &place) const
    {
      return axes_.transpose() * (place - origin_);
    }

    /// Such a place, moved into the half-space where it lies above: points of a curved flank lie above its
    /// tangent plane. [mm]
    static Eigen::Vector3d inside(const Eigen::Vector3d &relative)
    {
      return { relative.x(), relative.y(), std::max(0.0, relative.z()) };
    }

    /// Columns: the half-space's axes in the body's.
    const Eigen::Matrix3d &axes() const { return axes_; }

  private:
    Eigen::Vector3d origin_;
    Eigen::Matrix3d axes_;
  };
} // namespace flank
