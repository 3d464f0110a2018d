// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/flank_block.hpp"

#include <optional>

namespace flank
{
  /// A contact cell as one body sees it: uniform pressure on a polygon of its flank, in the canonical frame.
  struct Patch
  {
    int                          tooth; ///< counted counter-clockwise from the reference tooth
    std::vector<Eigen::Vector2d> outline; ///< corners (q = roll^2, z)
    double                       roll, z; ///< centre [rad, mm]
    double                       half_profile, half_generator; ///< of the rectangle of equal area and second moments [mm]
  };

  enum class Split
  {
    projected, ///< finite elements plus half-space minus what the elements make of the half-space; no dial
    classical  ///< Vijayakar's: half-space relative to a point below the surface, finite elements at that point
  };

  /// How the classical split picks the point below the surface.
  enum class ClassicalDepth
  {
    half_element, ///< half an element, as P1
    line_fit      ///< a straight line over 0.75 to 2 elements extrapolated to the surface
  };

  /// One elastic body ready for contact: the far field of the finite elements joined to the near field of the half-space.
  class BodyCompliance
  {
  public:
    BodyCompliance(const Gear &gear, const SectorResolution &resolution, int max_offset, Split split, ClassicalDepth depth);

    /// Compliance between patches [mm/N], n x n, symmetrised; `asymmetry` receives max|C - C'| / max C before that.
    Eigen::MatrixXd between(const std::vector<Patch> &patches, double &asymmetry) const;

    /// Own compliance of a patch by the finite elements without any near field. [mm/N]
    double elements_alone(const Patch &patch) const;

    const FlankCompliance &far_field() const { return far_field_; }
    int                    n_unknowns() const { return body_.n_unknowns(); }
    int                    max_offset() const { return static_cast<int>(far_field_.by_tooth_offset.size()) - 1; }

  private:
    struct Weighted; ///< a patch with its nodal weights
    Weighted weigh(const Patch &patch) const;
    void     add_projected(const std::vector<Patch> &patches, const std::vector<Weighted> &weights, Eigen::MatrixXd &c) const;
    void     add_classical(const std::vector<Patch> &patches, const std::vector<Weighted> &weights, Eigen::MatrixXd &c) const;
    Eigen::VectorXd free_face_forces(const Patch &patch, const FlankBlock &block, const Eigen::Matrix3d &axes, const Eigen::Vector3d &origin,
                                     const std::vector<Eigen::Vector4d> &points) const;
    Eigen::VectorXd block_response(const Patch &patch, const Weighted &weight, const FlankBlock &block, int layer_shift) const;

    Gear                       gear_;
    InvoluteHelicoid           helicoid_;
    Split                      split_;
    ClassicalDepth             depth_;
    ToothSector                sector_;
    ElasticBody                body_;
    FlankCompliance            far_field_;
    std::optional<FlankBlocks> blocks_;
  };
} // namespace flank
