// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/flank_ends.hpp"

#include "contact/half_space/half_space.hpp"
#include "mesh/base/errors.hpp"

#include <cmath>

namespace flank
{
  namespace
  {
    /// Which way the wedge's axis s, away from its edge, runs along the generator.
    double along_generator(const FlankEnd end)
    {
      return -sign_of(end);
    }

    std::size_t number(const FlankEnd end)
    {
      FLANK_ASSERT(end != FlankEnd::none, "an end");
      return static_cast<std::size_t>(end);
    }

    /// A place beside a force in the wedge's axes.
    Eigen::Vector3d in_wedge(const FlankEnd end, const double distance, const Eigen::Vector3d &relative)
    {
      return { relative.x(), distance + along_generator(end) * relative.y(), relative.z() };
    }
  } // namespace

  FlankEnds::FlankEnds(const Gear &gear, const bool free, const Faces *known)
      : free_(free)
      , youngs_modulus_(gear.youngs_modulus)
      , poissons_ratio_(gear.poissons_ratio)
      , base_helix_angle_(gear.base_helix_angle)
      , half_width_(gear.face_width / 2)
  {
    for (const FlankEnd end : { FlankEnd::low, FlankEnd::high })
      {
        End &of_end = ends_[number(end)];
        of_end.field = wedge::edge_field_on_demand(opening_at(gear, end), poissons_ratio_);
        if (known)
          std::call_once(of_end.face_once, [&] { of_end.face = (*known)[number(end)]; });
      }
  }

  double FlankEnds::distance(const FlankEnd end, const double z) const
  {
    return std::max(0.0, half_width_ + along_generator(end) * z) / std::cos(base_helix_angle_);
  }

  Eigen::Vector3d FlankEnds::displacement(const FlankEnd end, const double z,
                                          const Eigen::Vector3d &relative) const
  {
    Eigen::Vector3d result = half_space::boussinesq_displacement(relative, youngs_modulus_, poissons_ratio_);
    if (end == FlankEnd::none)
      return result;
    const double d = distance(end, z);
    Eigen::Vector3d added = field(end).displacement(in_wedge(end, d, relative), d) / youngs_modulus_;
    added.y() *= along_generator(end);
    return result + added;
  }

  Eigen::Matrix3d FlankEnds::added_stress(const FlankEnd end, const double z,
                                          const Eigen::Vector3d &relative) const
  {
    const double d = distance(end, z), nu = poissons_ratio_;
    const Eigen::Matrix3d gradient = field(end).gradient(in_wedge(end, d, relative), d),
                          strain = 0.5 * (gradient + gradient.transpose());
    Eigen::Matrix3d stress =
        (strain + nu / (1 - 2 * nu) * strain.trace() * Eigen::Matrix3d::Identity()) / (1 + nu);
    stress.row(1) *= along_generator(end);
    stress.col(1) *= along_generator(end);
    return stress;
  }

  const wedge::EdgeField &FlankEnds::field(const FlankEnd end) const
  {
    return ends_[number(end)].field->field();
  }

  const wedge::FaceTable &FlankEnds::face(const FlankEnd end) const
  {
    End &of_end = ends_[number(end)];
    std::call_once(of_end.face_once, [&] { of_end.face = field(end).face(); });
    return of_end.face;
  }

  wedge::Strip FlankEnds::strip(const FlankEnd end, const double z, const double half_generator) const
  {
    // The cells of a slice lie on one strip, but for rounding.
    const double rounding = 1e-11 * half_width_,
                 middle = (half_width_ + along_generator(end) * z) / std::cos(base_helix_angle_);
    const auto rounded = [&](const double at) { return std::max(0.0, rounding * std::round(at / rounding)); };
    return { rounded(middle - half_generator), rounded(middle + half_generator) };
  }
} // namespace flank
