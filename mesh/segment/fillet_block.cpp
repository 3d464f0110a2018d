// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/fillet_block.hpp"

#include "mesh/segment/extrusion.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr double growth = 1.6; ///< thickness of one over that of the one above it

    Eigen::Vector2d unit(const double angle)
    {
      return { std::cos(angle), std::sin(angle) };
    }
  } // namespace

  FilletBlock::FilletBlock(const ToothSector &sector, const int side)
      : gear_(sector.gear)
      , profile_(sector.gear)
      , side_(side)
      , layers_(sector.resolution.face_layers)
      , arc_(profile_.fillet_length())
  {
    divide();
    const int n = along() + 1, m = deep() + 1;
    SectionMesh section;
    for (int d = 0; d < m; ++d)
      for (int a = 0; a < n; ++a)
        section.vertices.push_back(
            section_point(cell(std::min(a, n - 2), std::min(d, m - 2), 0), a == n - 1, d == m - 1));
    for (int d = 0; d + 1 < m; ++d)
      for (int a = 0; a + 1 < n; ++a)
        section.quads.push_back({ d * n + a, d * n + a + 1, (d + 1) * n + a, (d + 1) * n + a + 1 });
    section.map = [own = *this](const int quad, const double along, const double inwards) {
      return own.section_point(quad, along, inwards);
    };
    mesh_ = extruded(section, gear_, layers_);
  }

  /// From the fillet's upper end, so that no contact lies on the band, to half a fillet radius along the
  /// land, where it is as long; two inwards, where tooth and rim are as thick.
  void FilletBlock::divide()
  {
    const double rho = gear_.fillet_radius, land = profile_.root_land_angle() * gear_.root_radius,
                 tooth = profile_.fillet_point(0).y(), rim = gear_.root_radius - gear_.bore_radius,
                 along_land = std::min(0.5 * rho, land),
                 depth = std::min({ 2 * rho, 0.6 * tooth, 0.6 * rim });
    for (int i = 0; i <= over_arc; ++i)
      stations_.push_back(arc_ * i / over_arc);
    if (along_land > 1e-3 * rho) // else an end there is as good
      stations_.push_back(arc_ + along_land);
    const double first = depth * (growth - 1) / (std::pow(growth, below_surface) - 1);
    for (int i = 0; i <= below_surface; ++i)
      depths_.push_back(first * (std::pow(growth, i) - 1) / (growth - 1));
  }

  FilletBlock::SurfacePoint FilletBlock::surface(const double distance) const
  {
    if (distance > arc_)
      {
        const Eigen::Vector2d radial = unit(profile_.root_angle() + (distance - arc_) / gear_.root_radius);
        return { gear_.root_radius * radial, -radial };
      }
    const Eigen::Vector2d p = profile_.fillet_point(distance / arc_);
    return { p, (p - profile_.fillet_centre()) / gear_.fillet_radius };
  }

  Eigen::Vector2d FilletBlock::section_point(const int cell, const double along, const double inwards) const
  {
    const int a = cell % this->along(), d = cell / this->along() % deep();
    const bool other = side_ == 1;
    const std::size_t from = other ? this->along() - a : a, to = other ? from - 1 : from + 1;
    const SurfacePoint at = surface((1 - along) * stations_[from] + along * stations_[to]);
    const Eigen::Vector2d p =
        at.position + ((1 - inwards) * depths_[d] + inwards * depths_[d + 1]) * at.inward;
    return other ? Eigen::Vector2d(p.x(), -p.y()) : p;
  }
} // namespace flank
