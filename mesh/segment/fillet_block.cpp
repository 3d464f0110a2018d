// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/fillet_block.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace flank
{
  namespace
  {
    /// Elements along the land and inwards.
    constexpr int beyond = 1, inwards = 4;

    /// Thickness of an element over that of the one before it.
    constexpr double growth = 1.6;

    Eigen::Vector2d unit(const double angle)
    {
      return { std::cos(angle), std::sin(angle) };
    }

    /// Sums of a geometric series of n terms whose first is 1, from 0 on, over the whole sum.
    std::vector<double> graded(const int n)
    {
      std::vector<double> result = { 0 };
      for (int i = 0; i < n; ++i)
        result.push_back(result.back() + std::pow(growth, i));
      for (double &value : result)
        value /= std::pow(growth, n) / (growth - 1) - 1 / (growth - 1);
      return result;
    }
  } // namespace

  FilletBlock::FilletBlock(const ToothSector &sector, const int side)
      : gear_(sector.gear)
      , profile_(sector.gear)
      , side_(side)
      , layers_(sector.resolution.face_layers)
      , arc_(profile_.fillet_length())
  {
    divide(sector.gear);
    const InvoluteHelicoid helicoid = sector.gear.flank();
    const double bottom = -sector.gear.face_width / 2, height = sector.layer_height();
    const auto turned = [twist = helicoid.twist()](const Eigen::Vector2d &p, const double z) {
      const double c = std::cos(twist * z), s = std::sin(twist * z);
      return Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), z);
    };
    const int n = along() + 1, m = deep() + 1;
    for (int k = 0; k <= layers_; ++k)
      for (int d = 0; d < m; ++d)
        for (int a = 0; a < n; ++a)
          mesh_.vertices.push_back(
              turned(section_point(cell(std::min(a, n - 2), std::min(d, m - 2), 0), a == n - 1, d == m - 1),
                     bottom + k * height));
    for (int k = 0; k < layers_; ++k)
      for (int d = 0; d + 1 < m; ++d)
        for (int a = 0; a + 1 < n; ++a)
          {
            std::array<int, 8> corners{};
            for (int i = 0; i < 8; ++i)
              corners[i] = ((k + (i >> 2)) * m + d + (i >> 1 & 1)) * n + a + (i & 1);
            mesh_.cells.push_back(corners);
          }
    mesh_.map = [own = std::make_shared<FilletBlock>(*this), turned, bottom,
                 height](const int cell, const Eigen::Vector3d &x) {
      const int layer = cell / (own->along() * own->deep());
      return turned(own->section_point(cell, x[0], x[1]), bottom + (layer + x[2]) * height);
    };
  }

  /// From the fillet's upper end, so that no contact lies on the band, to half a fillet radius along the
  /// land, where it is as long; two inwards, where tooth and rim are as thick.
  void FilletBlock::divide(const Gear &gear)
  {
    const double rho = gear.fillet_radius, land = profile_.root_land_angle() * gear.root_radius,
                 tooth = profile_.fillet_point(0).y(), rim = gear.root_radius - gear.bore_radius,
                 down = std::min(0.5 * rho, land), depth = std::min({ 2 * rho, 0.6 * tooth, 0.6 * rim });
    const std::vector<double> of_end = graded(beyond), of_depth = graded(inwards);
    for (int i = 0; i <= over_arc; ++i)
      stations_.push_back(arc_ * i / over_arc);
    if (down > 1e-3 * rho) // else an end there is as good
      for (int i = 1; i <= beyond; ++i)
        stations_.push_back(arc_ + down * of_end[i]);
    for (const double share : of_depth)
      depths_.push_back(depth * share);
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
