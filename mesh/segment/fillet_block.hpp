// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/tooth_sector.hpp"

namespace flank
{
  /// Elements of their own about one root fillet of a tooth sector, where those of the sector are as large as
  /// the fillet's radius: a curved band along the surface, over the fillet to the root land, whose elements
  /// stand normal to the surface and grow thicker inwards. Its layers along the face are the sector's.
  /// Reference axes of every cell: along the surface, inwards (other side: the surface is followed from the
  /// land to the flank), along +z.
  class FilletBlock
  {
  public:
    /// Elements over the fillet's arc; along the surface at most; below it.
    static constexpr int over_arc = 5, most_along = over_arc + 1, below_surface = 4;

    /// side 0: below the loaded flank, 1: below the other. The sector is not kept.
    FilletBlock(const ToothSector &sector, int side);

    const HexMesh &mesh() const { return mesh_; }
    int along() const { return static_cast<int>(stations_.size()) - 1; } ///< elements along the surface
    int deep() const { return static_cast<int>(depths_.size()) - 1; }
    int layers() const { return layers_; }
    int cell(const int along, const int deep, const int layer) const
    {
      return (layer * this->deep() + deep) * this->along() + along;
    }

    /// Elements along the surface that have a face on the fillet: the first and the last.
    std::array<int, 2> on_fillet() const
    {
      return side_ == 0 ? std::array{ 0, over_arc - 1 } : std::array{ along() - over_arc, along() - 1 };
    }

    /// Exact position in the transverse section at mid-face of a reference point of a cell. [mm]
    Eigen::Vector2d section_point(int cell, double along, double inwards) const;

  private:
    void divide();

    /// A point of the surface and the unit normal into the tooth there, on the side of the loaded flank, by
    /// its distance along the surface from the fillet's upper end. [mm]
    struct SurfacePoint
    {
      Eigen::Vector2d position, inward;
    };
    SurfacePoint surface(double distance) const;

    Gear gear_;
    ToothProfile profile_;
    int side_, layers_;
    double arc_; ///< length of the fillet [mm]
    std::vector<double>
        stations_; ///< distances along the surface from the fillet's upper end where elements meet [mm]
    std::vector<double> depths_; ///< below it [mm]
    HexMesh mesh_;
  };
} // namespace flank
