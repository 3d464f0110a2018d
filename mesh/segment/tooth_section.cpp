// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/segment/tooth_section.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/tip_edge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr double most_growth = 3; ///< of a rim's layers from the root on
    constexpr double halving = 0.5;   ///< of those before the bore

    /// How many of n layers of a rim halve towards the bore.
    int halving_layers(const int n)
    {
      return std::min(n - 1, (n + 3) / 3);
    }

    /// Thickness of so many layers, of which the first is as thick as the one before them, over that.
    double sum_of_halving(const int layers)
    {
      return (1 - std::pow(halving, layers)) / (1 - halving);
    }

    /// Height of a row of the involute, along its arc. [mm]
    double row_height(const Gear &gear, const SectorResolution &resolution)
    {
      return profile_length(gear.form_roll, body_tip_roll(gear), gear.base_radius) / resolution.flank_rows;
    }

    /// Thickness of the rim's layer below the root. [mm]
    double first_layer(const Gear &gear, const SectorResolution &resolution)
    {
      return 1.2 * row_height(gear, resolution);
    }

    /// Ratio g of a geometric series of n terms whose first is `first` and whose sum, with `after_last` times
    /// its last term, is `sum`; limited to [1, most_growth].
    double growth_ratio(const double first, const double sum, const int n, const double after_last)
    {
      double low = 1, high = most_growth;
      for (int i = 0; i < 60; ++i)
        {
          const double g = 0.5 * (low + high);
          double total = 0, term = first;
          for (int k = 0; k < n; ++k, term *= g)
            total += term;
          (total + after_last * term / g < sum ? low : high) = g;
        }
      return low;
    }

    Eigen::Vector2d polar(const double radius, const double angle)
    {
      return { radius * std::cos(angle), radius * std::sin(angle) };
    }
  } // namespace

  void SectorResolution::check() const
  {
    if (degree < 1 || degree > 3)
      throw InputError(fmt::format("element degree {} must be 1, 2 or 3", degree), "element degree");
    if (tooth_columns % 2 != 0)
      throw InputError(fmt::format("{} columns across the tooth must be an even number", tooth_columns),
                       "tooth columns");
    FLANK_ASSERT(flank_rows >= 2 && tooth_columns >= 2 && face_layers >= 1 && fillet_rows >= 1 &&
                     fillet_columns >= 1 && root_land_columns >= 1 && rim_layers >= 1,
                 "");
  }

  SectorResolution coarser(const SectorResolution &resolution)
  {
    const auto fewer = [](const int count, const int least) {
      return std::min(count, std::max(least, static_cast<int>(std::lround(0.6 * count))));
    };
    const auto fewer_pairs = [&](const int count) { return 2 * fewer(count / 2, 1); };
    SectorResolution result = resolution;
    // What costs most, near-field tables, grows with the rows, and the least of the error is theirs.
    result.flank_rows = std::min(resolution.flank_rows, std::max(2, resolution.flank_rows / 2));
    result.tooth_columns = fewer_pairs(resolution.tooth_columns);
    // More than one pair of layers stays an even number: halves of a spur body are alike.
    const int layers = resolution.face_layers;
    result.face_layers = layers % 2 == 0 && layers > 2 ? fewer_pairs(layers) : fewer(layers, 1);
    result.fillet_rows = fewer(resolution.fillet_rows, 1);
    result.fillet_columns = fewer(resolution.fillet_columns, 1);
    // Two kinds of layers share the rim: with few of both its error would grow at once.
    const int rim = resolution.rim_layers;
    result.rim_layers = std::max(1, std::min(rim - 1, static_cast<int>(std::lround(0.75 * rim))));
    return result;
  }

  int enough_rim_layers(const Gear &gear, const SectorResolution &resolution)
  {
    const double thickness = gear.root_radius - gear.bore_radius;
    const auto reach_of = [&](const int n) {
      const double last = std::pow(most_growth, n - halving_layers(n) - 1);
      return first_layer(gear, resolution) *
             ((most_growth * last - 1) / (most_growth - 1) + last * sum_of_halving(halving_layers(n)));
    };
    constexpr int most = 50; // a rim of 1e9 rows
    int n = resolution.rim_layers;
    while (n < most && reach_of(n) < thickness)
      ++n;
    return n;
  }

  ToothSection::ToothSection(const Gear &gear, const SectorResolution &resolution)
      : gear_(gear)
      , profile_(gear)
      , resolution_(resolution)
  {
    resolution.check();
    rim_columns_ = resolution.tooth_columns + 2 * side_columns();
    divide_side();
    place_tooth();
    place_rim();
    make_tooth_quads();
    make_rim_quads();
  }

  /// The loaded side from the tip down: involute in equal arcs (equal steps of q = roll^2), radial line,
  /// upper half of the fillet.
  void ToothSection::divide_side()
  {
    const int rows = resolution_.flank_rows, fillet_rows = resolution_.fillet_rows;
    const double q_tip = std::pow(body_tip_roll(gear_), 2), q_form = std::pow(gear_.form_roll, 2);
    for (int r = 0; r < rows; ++r)
      row_curves_.push_back(
          { Edge::involute, q_of_row(q_tip, q_form, r, rows), q_of_row(q_tip, q_form, r + 1, rows) });
    const double form_radius = profile_.form_radius(),
                 radial_length = form_radius - profile_.fillet_top_radius();
    if (radial_length > 1e-9)
      {
        const int radial_rows =
            std::max(1, static_cast<int>(std::ceil(radial_length / row_height(gear_, resolution_))));
        for (int r = 0; r < radial_rows; ++r)
          row_curves_.push_back({ Edge::radial_line, form_radius - radial_length * r / radial_rows,
                                  form_radius - radial_length * (r + 1) / radial_rows });
      }
    for (int r = 0; r < fillet_rows; ++r)
      row_curves_.push_back({ Edge::fillet, 0.5 * r / fillet_rows, 0.5 * (r + 1) / fillet_rows });
  }

  /// Places the tooth's vertices: those of each row on a circle about the axis, at equal angles.
  void ToothSection::place_tooth()
  {
    const int columns = resolution_.tooth_columns;
    for (int row = 0; row <= tooth_rows(); ++row)
      {
        const bool is_end = row == tooth_rows();
        const Eigen::Vector2d side = along(row_curves_[is_end ? row - 1 : row], 0, 0, is_end ? 1 : 0);
        const double angle = std::atan2(side.y(), side.x());
        for (int c = 0; c <= columns; ++c)
          vertices_.push_back(polar(side.norm(), angle * (1 - 2.0 * c / columns)));
      }
    if (has_chamfers(gear_))
      place_land();
  }

  /// Chamfers are the tops of the outermost columns, or of two columns parts of their tops.
  void ToothSection::place_land()
  {
    const int columns = resolution_.tooth_columns;
    const int of_land = std::max(columns - 2, 2), first = columns > 2 ? 1 : 0;
    for (int c = 1; c < columns; ++c)
      vertices_[tooth_vertex(0, c)] =
          polar(gear_.tip_radius, half_land_angle(gear_) * (1 - 2.0 * (c - first) / of_land));
  }

  /// From a flank's end over the chamfer and the land to the tooth's middle, by shares of the length.
  Eigen::Vector2d ToothSection::half_of_tip(const double share) const
  {
    const double half_land = half_land_angle(gear_), land = gear_.tip_radius * half_land;
    const Eigen::Vector2d end = vertices_[tooth_vertex(0, 0)], corner = polar(gear_.tip_radius, half_land);
    const double chamfer = (corner - end).norm(), along = share * (chamfer + land);
    if (along < chamfer)
      return end + along / chamfer * (corner - end);
    return polar(gear_.tip_radius, half_land * (1 - (along - chamfer) / land));
  }

  /// Stress is singular where the clamped bore meets the side faces, and strain under a torque grows with
  /// 1/r^2 to the bore: a third of the layers halve towards it, as long as they stay thicker than the bore
  /// bends over an element. Those before them grow from the root on.
  void ToothSection::grade_rim()
  {
    const int n = resolution_.rim_layers;
    const double thickness = gear_.root_radius - gear_.bore_radius,
                 bend = gear_.bore_radius * (1 - std::cos(units::pi / (gear_.teeth * rim_columns_)));
    for (int inner = halving_layers(n); inner >= 0; --inner)
      {
        const int outer = n - inner;
        const double of_inner = sum_of_halving(inner),
                     first = std::min(thickness / (outer + of_inner), first_layer(gear_, resolution_)),
                     growth = growth_ratio(first, thickness, outer, of_inner),
                     innermost = first * std::pow(growth, outer - 1) * std::pow(halving, inner - 1);
        rim_blocks_ = { { outer, growth } };
        if (inner > 0)
          rim_blocks_.push_back({ inner, halving });
        if (innermost > 4 * bend)
          return;
      }
  }

  /// Places the rim's vertices. The upper ones run along root land, lower fillet, tooth base, lower fillet,
  /// root land; straight lines lead to the bore.
  void ToothSection::place_rim()
  {
    const int columns = resolution_.tooth_columns, land = resolution_.root_land_columns;
    const double half_pitch = units::pi / gear_.teeth, root_angle = profile_.root_angle();
    std::vector<Eigen::Vector2d> top;
    for (int c = 0; c < land; ++c)
      top.push_back(polar(gear_.root_radius, half_pitch + (root_angle - half_pitch) * c / land));
    for (int c = 0; c < resolution_.fillet_columns; ++c)
      top.push_back(profile_.fillet_point(1 - 0.5 * c / resolution_.fillet_columns));
    for (int c = 0; c <= columns; ++c)
      top.push_back(vertices_[tooth_vertex(tooth_rows(), c)]);
    for (int c = side_columns() - 1; c >= 0; --c)
      top.emplace_back(top[c].x(), -top[c].y());

    grade_rim();
    std::vector<double> depth = { 0 };
    double layer = 1;
    for (const RimBlock &block : rim_blocks_)
      for (int l = 0; l < block.layers; ++l)
        {
          if (l > 0)
            layer *= block.growth;
          depth.push_back(depth.back() + layer);
        }
    for (int c = 0; c <= rim_columns_; ++c)
      for (int l = 0; l <= resolution_.rim_layers; ++l)
        {
          if (l == 0 && c >= side_columns() && c <= side_columns() + columns)
            continue; // shared with the tooth
          const Eigen::Vector2d bore = polar(gear_.bore_radius, half_pitch * (1 - 2.0 * c / rim_columns_));
          vertices_.push_back(top[c] + depth[l] / depth.back() * (bore - top[c]));
        }
  }

  /// Along a circle about the axis.
  ToothSection::Curve ToothSection::arc(const int from_vertex, const int to_vertex) const
  {
    const auto angle_of = [&](const int vertex) {
      return std::atan2(vertices_[vertex].y(), vertices_[vertex].x());
    };
    return { Edge::circle, angle_of(from_vertex), angle_of(to_vertex), vertices_[from_vertex].norm() };
  }

  void ToothSection::make_tooth_quads()
  {
    const int columns = resolution_.tooth_columns;
    for (int row = 0; row < tooth_rows(); ++row)
      for (int c = 0; c < columns; ++c)
        {
          Quad quad;
          quad.vertices = { tooth_vertex(row, c), tooth_vertex(row + 1, c), tooth_vertex(row, c + 1),
                            tooth_vertex(row + 1, c + 1) };
          if (c == 0)
            quad.at_across_0 = row_curves_[row];
          if (c == columns - 1)
            {
              quad.at_across_1 = row_curves_[row];
              quad.at_across_1.mirrored = true;
            }
          if (row == 0 && !is_chamfer(row, c))
            quad.at_down_0 = arc(quad.vertices[0], quad.vertices[2]);
          else if (row == 0 && columns == 2)
            quad.at_down_0 = { Edge::half_of_tip, 1.0 * c, 1.0 - c, 0, c == 1 };
          quads_.push_back(quad);
        }
  }

  void ToothSection::make_rim_quads()
  {
    const int land = resolution_.root_land_columns;
    for (int c = 0; c < rim_columns_; ++c)
      for (int l = 0; l < resolution_.rim_layers; ++l)
        {
          Quad quad;
          quad.vertices = { rim_vertex(c, l), rim_vertex(c, l + 1), rim_vertex(c + 1, l),
                            rim_vertex(c + 1, l + 1) };
          const int from_side = std::min(c, rim_columns_ - 1 - c);
          if (l == 0 && from_side < land)
            quad.at_down_0 = arc(quad.vertices[0], quad.vertices[2]);
          else if (l == 0 && from_side < side_columns())
            {
              const double outer = 1 - 0.5 * (from_side - land) / resolution_.fillet_columns,
                           inner = 1 - 0.5 * (from_side - land + 1) / resolution_.fillet_columns;
              const bool other = c != from_side;
              quad.at_down_0 = { Edge::fillet, other ? inner : outer, other ? outer : inner, 0, other };
            }
          if (l == resolution_.rim_layers - 1)
            quad.at_down_1 = arc(quad.vertices[1], quad.vertices[3]);
          quads_.push_back(quad);
        }
  }

  bool ToothSection::is_chamfer(const int row, const int column) const
  {
    return has_chamfers(gear_) && row == 0 && (column == 0 || column == tooth_columns() - 1);
  }

  int ToothSection::tooth_vertex(const int row, const int column) const
  {
    return row * (tooth_columns() + 1) + column;
  }

  int ToothSection::rim_vertex(const int column, const int layer) const
  {
    const int side = (rim_columns_ - tooth_columns()) / 2, first = (tooth_rows() + 1) * (tooth_columns() + 1);
    const int in_tooth =
        std::clamp(column - side, 0, tooth_columns() + 1); // columns before this one that lack layer 0
    if (layer == 0 && column >= side && column <= side + tooth_columns())
      return tooth_vertex(tooth_rows(), column - side);
    const bool shared = column >= side && column <= side + tooth_columns();
    return first + column * (rim_layers() + 1) - in_tooth + layer - (shared ? 1 : 0);
  }

  Eigen::Vector2d ToothSection::along(const Curve &curve, const int from_vertex, const int to_vertex,
                                      const double t) const
  {
    const double parameter = curve.from + t * (curve.to - curve.from);
    Eigen::Vector2d point;
    switch (curve.kind)
      {
      case Edge::straight:
        return (1 - t) * vertices_[from_vertex] + t * vertices_[to_vertex];
      case Edge::circle:
        return polar(curve.radius, parameter);
      case Edge::involute:
        point = profile_.involute_point(std::sqrt(std::max(0.0, parameter)));
        break;
      case Edge::radial_line:
        point = profile_.radial_line_point(parameter);
        break;
      case Edge::fillet:
        point = profile_.fillet_point(parameter);
        break;
      case Edge::half_of_tip:
        point = half_of_tip(parameter);
        break;
      }
    return curve.mirrored ? Eigen::Vector2d(point.x(), -point.y()) : point;
  }

  Eigen::Vector2d ToothSection::map(const int index, const double s, const double t) const
  {
    const Quad &quad = quads_[index];
    const auto &v = quad.vertices;
    return (1 - t) * along(quad.at_across_0, v[0], v[1], s) + t * along(quad.at_across_1, v[2], v[3], s) //
           + (1 - s) * along(quad.at_down_0, v[0], v[2], t) + s * along(quad.at_down_1, v[1], v[3], t)   //
           - ((1 - s) * (1 - t) * vertices_[v[0]] + s * (1 - t) * vertices_[v[1]] +
              (1 - s) * t * vertices_[v[2]] + s * t * vertices_[v[3]]);
  }
} // namespace flank
