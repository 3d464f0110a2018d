// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/hex_mesh.hpp"
#include "mesh/segment/tooth_section.hpp"

namespace flank
{
  /// One tooth sector of a gear in the canonical frame (right-hand helix, loaded flank on the
  /// counter-clockwise side): the transverse section meshed and extruded by Gmsh, every cell's exact geometry
  /// by the section's map turned with z. Reference axes of every cell: down (tip to bore), across (loaded
  /// flank to the other), along +z.
  struct ToothSector
  {
    Gear gear;
    SectorResolution resolution;
    ToothSection section;
    HexMesh mesh;

    double layer_height() const { return gear.face_width / resolution.face_layers; }

    /// Index into mesh.cells.
    int tooth_cell(const int row, const int column, const int layer) const
    {
      return cell(section.tooth_quad(row, column), layer);
    }
    int rim_cell(const int column, const int rim_layer, const int layer) const
    {
      return cell(section.rim_quad(column, rim_layer), layer);
    }

  private:
    int cell(const int quad, const int layer) const
    {
      return layer * static_cast<int>(section.quads().size()) + quad;
    }
  };

  /// Version of the Gmsh library this was built with.
  std::string gmsh_version();

  /// Meshes one sector with Gmsh. Throws LibraryError where there is none, ComputationError if Gmsh returns
  /// another mesh than the section describes.
  ToothSector make_tooth_sector(const Gear &gear, const SectorResolution &resolution);

  /// `teeth` rotated copies of the sector with common vertices on the cuts between them: a segment, or the
  /// whole gear if they are all its teeth. Cell t*n + c is cell c of tooth t, tooth t turned by t pitches
  /// counter-clockwise.
  HexMesh joined_sectors(const ToothSector &sector, int teeth);
} // namespace flank
