// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"
#include "mesh/gear/tooth_profile.hpp"

#include <array>
#include <string>
#include <vector>

namespace flank
{
  /// Numbers of elements of one tooth sector.
  struct SectorResolution
  {
    int degree = 2;            ///< polynomial degree of the elements and of their geometry, 1 to 3
    int flank_rows = 9;        ///< along the involute, equal arcs
    int tooth_columns = 6;     ///< across the tooth
    int face_layers = 10;      ///< along the face width
    int fillet_rows = 2;       ///< upper half of the fillet, belonging to the tooth
    int fillet_columns = 2;    ///< lower half of the fillet, belonging to the rim
    int root_land_columns = 1; ///< half the root land
    int rim_layers = 7;        ///< from the root to the bore, graded

    /// Throws InputError for numbers that cannot be meshed.
    void check() const;
  };

  /// The least number of rim layers, not below the resolution's, whose first one is no thicker than an
  /// element of the tooth asks for: each is three times as thick as the one before it at most.
  int enough_rim_layers(const Gear &gear, const SectorResolution &resolution);

  /// About three fifths as many elements in every direction, three quarters in the rim, of the same degree;
  /// never fewer than can be meshed. For estimates of what the elements' size makes wrong.
  SectorResolution coarser(const SectorResolution &resolution);

  /// q = roll^2 where a row of elements of the flank begins, counted from the tip and with fractions: rows
  /// are equal steps of q, which are equal arcs. [rad^2]
  constexpr double q_of_row(const double q_tip, const double q_form, const double row, const int rows)
  {
    return q_tip + (q_form - q_tip) * row / rows;
  }

  /// Transverse section of one tooth sector at mid-face as a structured set of quadrilaterals:
  /// the tooth (rows from tip to mid-fillet, columns from the loaded flank to the other) on top of the rim
  /// (columns from the cut at +pitch/2 to the cut at -pitch/2, layers from the root to the bore).
  /// Local axes of every quadrilateral: first downwards (tip to bore), second from the +angle to the -angle
  /// side.
  class ToothSection
  {
  public:
    enum class Edge
    {
      straight,
      involute,
      radial_line,
      fillet,
      half_of_tip,
      circle
    };

    /// A curve between two vertices; from/to are q = roll^2, radius, fraction or angle by its kind.
    struct Curve
    {
      Edge kind = Edge::straight;
      double from = 0, to = 0, radius = 0;
      bool mirrored = false; ///< on the clockwise side of the tooth
    };

    struct Quad
    {
      std::array<int, 4> vertices;    ///< at (0,0), (1,0), (0,1), (1,1) of (down, across)
      Curve at_across_0, at_across_1; ///< along "down"
      Curve at_down_0, at_down_1;     ///< along "across"
    };

    ToothSection(const Gear &gear, const SectorResolution &resolution);

    const std::vector<Eigen::Vector2d> &vertices() const { return vertices_; }
    const std::vector<Quad> &quads() const { return quads_; }

    int tooth_rows() const
    {
      return static_cast<int>(row_curves_.size());
    } ///< involute, radial line and upper fillet
    int tooth_columns() const { return resolution_.tooth_columns; }
    int rim_columns() const { return rim_columns_; }
    int rim_layers() const { return resolution_.rim_layers; }

    /// Successive layers of the rim, from the root inwards, whose thicknesses have one ratio.
    struct RimBlock
    {
      int layers;
      double growth;
    };
    const std::vector<RimBlock> &rim_blocks() const { return rim_blocks_; }

    /// Whether the top of a quadrilateral of the tooth is a chamfer, or has one.
    bool is_chamfer(int row, int column) const;

    int tooth_vertex(int row, int column) const;
    int rim_vertex(int column, int layer) const;
    int tooth_quad(int row, int column) const { return row * tooth_columns() + column; }
    int rim_quad(int column, int layer) const
    {
      return tooth_rows() * tooth_columns() + column * rim_layers() + layer;
    }

    /// Exact position of a reference point of a quadrilateral (transfinite blend of its four edges). [mm]
    Eigen::Vector2d map(int quad, double down, double across) const;

  private:
    void divide_side();
    void place_tooth();
    void place_land();
    void place_rim();
    void grade_rim();
    void make_tooth_quads();
    void make_rim_quads();

    /// Columns of the rim beside the tooth, on one side.
    int side_columns() const { return resolution_.fillet_columns + resolution_.root_land_columns; }
    Eigen::Vector2d half_of_tip(double share) const;
    Curve arc(int from_vertex, int to_vertex) const;
    Eigen::Vector2d along(const Curve &curve, int from_vertex, int to_vertex, double t) const;

    Gear gear_;
    ToothProfile profile_;
    SectorResolution resolution_;
    int rim_columns_;
    std::vector<RimBlock> rim_blocks_;
    std::vector<Curve> row_curves_; ///< the loaded side's edge of each tooth row
    std::vector<Eigen::Vector2d> vertices_;
    std::vector<Quad> quads_;
  };
} // namespace flank
