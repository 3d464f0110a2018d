// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/mesh_position.hpp"

#include "contact/flanks/tip_edges.hpp"

#include "mesh/base/gauss.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    double square(const double v)
    {
      return v * v;
    }

    /// How far a tip rounding falls back from the involute. [mm]
    double rounding_drop(const Gear &gear, const double roll)
    {
      if (gear.tip_rounding == 0 || roll <= gear.usable_tip_roll)
        return 0;
      const double along = profile_length(gear.usable_tip_roll, roll, gear.base_radius),
                   rho = gear.tip_rounding;
      // The rounding's arc, up to 0.95 rho along the flank. The arc ends upright at rho; beyond 0.95 rho
      // stands its tangent at that place: drop 1 - sqrt(1 - 0.95^2) = 0.6877, slope 0.95 / sqrt(1 - 0.95^2)
      // = 3.04.
      return along < 0.95 * rho ? rho - std::sqrt(square(rho) - square(along))
                                : rho * (0.6877 + 3.04 * (along / rho - 0.95));
    }
  } // namespace

  double end_roll(const Gear &gear)
  {
    return gear.tip_rounding > 0
               ? std::min(gear.tip_roll,
                          std::sqrt(roll_squared_at(square(gear.usable_tip_roll), 0.9 * gear.tip_rounding,
                                                    gear.base_radius)))
               : gear.usable_tip_roll;
  }

  double canonical_z_sign(const PairData &data)
  {
    // right/ccw: as it is; left/cw: mirrored in y; left/ccw: mirrored in z; right/cw: turned about x.
    // A spur pair is the limit of a right-hand pinion.
    return (data.helix_angle == 0 || data.pinion_hand == Hand::right) == data.counter_clockwise_drive ? 1
                                                                                                      : -1;
  }

  MeshPosition::MeshPosition(const GearPair &pair, const MeshDeviations &deviations, const double phase,
                             const EndsOfFlanks ends)
      : pair_(pair)
      , deviations_(deviations)
      , tan_pressure_angle_(std::tan(pair.working_pressure_angle))
      , phase_(phase)
      , z_sign_(canonical_z_sign(pair.data))
      , face_low_(z_sign_ > 0 ? pair.face_low : -pair.face_high)
      , face_high_(z_sign_ > 0 ? pair.face_high : -pair.face_low)
      , gear_z_(z_sign_ * pair.data.axial_offset)
      , end_powers_(end_powers(pair, ends))
      , tip_powers_(flank::tip_powers(pair, ends))
      , pinion_(pair.pinion.flank())
      , gear_(pair.gear.flank())
  {
  }

  double MeshPosition::contact_roll(const int pair, const double z) const
  {
    return tan_pressure_angle_ + (phase_ + pair) * pair_.pinion.pitch_angle() + z * pinion_.twist();
  }

  double MeshPosition::mate_roll(const double contact_roll) const
  {
    return pair_.facing_roll(pair_.gear, pair_.pinion, contact_roll);
  }

  /// Transverse distance from the point at `roll` of one involute to the other, along the tangent from the
  /// point to the other's base circle: exact, because the involute's normals are those tangents. Each gear in
  /// a frame at its own axis whose x axis points to the other's axis; the frames are half a turn apart.
  MeshPosition::Foot MeshPosition::foot(const Gear &from, const Gear &onto, const double from_angle,
                                        const double onto_angle, const double roll) const
  {
    const double sigma = from_angle - roll;
    const Eigen::Vector2d point =
        from.base_radius *
        Eigen::Vector2d(std::cos(sigma) - roll * std::sin(sigma), std::sin(sigma) + roll * std::cos(sigma));
    const Eigen::Vector2d seen(pair_.data.centre_distance - point.x(), -point.y());
    const double tangent = std::sqrt(std::max(0.0, seen.squaredNorm() - onto.base_radius * onto.base_radius));
    // The direction of `seen`, turned back by that of (base radius, tangent).
    const Eigen::Vector2d normal(seen.x() * onto.base_radius + seen.y() * tangent,
                                 seen.y() * onto.base_radius - seen.x() * tangent);
    const double normal_angle = std::atan2(normal.y(), normal.x()), onto_roll = onto_angle - normal_angle;
    return { tangent - onto.base_radius * onto_roll, onto_roll, normal_angle,
             point.dot(normal) / normal.norm() };
  }

  FacingPoints MeshPosition::facing(const int pair, const double pinion_roll, const double z) const
  {
    const double roll = contact_roll(pair, z), alpha = pair_.working_pressure_angle;
    const Foot on_gear = foot(pair_.pinion, pair_.gear, roll - alpha, mate_roll(roll) - alpha, pinion_roll);
    return { pinion_roll, on_gear.roll, z,
             pinion_.cos_base_helix() * (on_gear.distance + rounding_drop(pair_.pinion, pinion_roll) +
                                         rounding_drop(pair_.gear, on_gear.roll)) };
  }

  bool MeshPosition::on_flanks(const FacingPoints &points) const
  {
    constexpr double rounding = 1e-9; // an edge belongs to both flanks
    return points.pinion_roll >= pair_.pinion.form_roll - rounding &&
           points.pinion_roll <= end_roll(pair_.pinion) + rounding &&
           points.gear_roll >= pair_.gear.form_roll - rounding &&
           points.gear_roll <= end_roll(pair_.gear) + rounding;
  }

  /// Moments (point - mid-face of the axis) x normal about the axis at right angles to the plane of action
  /// (tilt in it) and about minus the line of action (tilt across it). On the plane of action the first is z
  /// cos(beta_b) + distance from the base tangent point times sin(beta_b).
  Eigen::Vector4d MeshPosition::tilt_levers(const Slice &slice, const double pinion_roll,
                                            const double z) const
  {
    const double alpha = pair_.working_pressure_angle,
                 sigma = contact_roll(slice.pair, z) - alpha - pinion_roll;
    const Eigen::Vector3d point(pair_.pinion.base_radius * (std::cos(sigma) - pinion_roll * std::sin(sigma)),
                                pair_.pinion.base_radius * (std::sin(sigma) + pinion_roll * std::cos(sigma)),
                                z);
    const Eigen::Vector3d normal(-std::sin(slice.normal_angle) * pinion_.cos_base_helix(),
                                 std::cos(slice.normal_angle) * pinion_.cos_base_helix(),
                                 -pinion_.sin_base_helix());
    const Eigen::Vector3d of_pinion = point.cross(normal),
                          of_gear =
                              (point - Eigen::Vector3d(pair_.data.centre_distance, 0, gear_z_)).cross(normal),
                          in_plane(-std::cos(alpha), std::sin(alpha), 0),
                          across(-std::sin(alpha), -std::cos(alpha), 0);
    return { in_plane.dot(of_pinion), across.dot(of_pinion), in_plane.dot(of_gear), across.dot(of_gear) };
  }

  double MeshPosition::gap(const Slice &slice, const FacingPoints &points) const
  {
    const double z = z_sign_ * points.z;
    double sum = points.separation + removed(deviations_.pinion.modifications, points.pinion_roll, z) +
                 removed(deviations_.gear.modifications, points.gear_roll, z - pair_.data.axial_offset);
    if (const Misalignment &tilt = deviations_.misalignment; tilt.in_plane != 0 || tilt.across != 0)
      {
        // About the pitch point at mid-face, so that nothing is added to the transmission error there.
        const double alpha = pair_.working_pressure_angle, rb = pair_.pinion.base_radius;
        const Eigen::Vector4d lever = tilt_levers(slice, points.pinion_roll, points.z);
        sum += z_sign_ * (tilt.in_plane * (lever[0] - pinion_.sin_base_helix() * rb * std::tan(alpha)) +
                          tilt.across * (lever[1] + pinion_.sin_base_helix() * rb));
      }
    return sum;
  }

  double MeshPosition::relative_radius(const Slice &slice) const
  {
    const auto curvature = [](const Gear &gear, const double roll) {
      return gear.tip_rounding > 0 && roll > gear.usable_tip_roll
                 ? 1 / std::min(gear.tip_rounding, gear.base_radius * roll)
                 : 1 / (gear.base_radius * roll);
    };
    return 1 / (pinion_.cos_base_helix() *
                (curvature(pair_.pinion, slice.pinion_roll) + curvature(pair_.gear, slice.gear_roll)));
  }

  double MeshPosition::distance_to_edge(const Slice &slice) const
  {
    const auto along = [](const Gear &gear, const double roll) {
      return profile_length(roll, end_roll(gear), gear.base_radius);
    };
    return std::max(0.0,
                    std::min(along(pair_.pinion, slice.pinion_roll), along(pair_.gear, slice.gear_roll)));
  }

  /// Equal cells over the window, but where the sharp tip edge of one spur gear lies in it: they then reach
  /// from the window's inner end to that edge, which bounds what it carries, and narrow towards it the more,
  /// the nearer it is to the window's middle. They depend on nothing that windows of equal compliance
  /// (PositionCompliance::Window) do not have: on no deviations.
  MeshPosition::Borders MeshPosition::borders_of_cells(const Slice &slice, const double middle,
                                                       const double half_width, const int across) const
  {
    Borders result;
    for (int c = 0; c <= across; ++c)
      result.at.push_back(middle + half_width * (2.0 * c / across - 1));
    const auto beyond_middle = [&](const Gear &gear, const double roll, const double way) {
      const bool is_sharp = gear.tip_rounding == 0 && pinion_.twist() == 0;
      return is_sharp ? profile_length(roll, end_roll(gear), gear.base_radius) - way * middle
                      : 2 * half_width;
    };
    const double to_pinion_tip = beyond_middle(pair_.pinion, slice.pinion_roll, 1),
                 to_gear_tip = beyond_middle(pair_.gear, slice.gear_roll, -1),
                 nearer = std::min(to_pinion_tip, to_gear_tip), way = to_pinion_tip < to_gear_tip ? 1 : -1;
    if (nearer >= half_width || nearer <= -half_width || std::max(to_pinion_tip, to_gear_tip) < half_width)
      return result;
    const double length = nearer + half_width, evenly = std::clamp(nearer / half_width, 0.0, 1.0);
    // A hundredth of the outermost cell, so that the edge cuts it as it cuts equal ones.
    const double beyond = 0.01 / across * (evenly + (1 - evenly) / across);
    for (int c = 0; c <= across; ++c)
      {
        const double share = 1.0 * c / across, inward = share * (evenly + (1 - evenly) * share),
                     from_middle = nearer - length * ((1 + beyond) * inward - beyond);
        result.at[static_cast<std::size_t>(way > 0 ? across - c : c)] = middle + way * from_middle;
      }
    const double edge = middle + way * nearer, beside = edge - way * 2 * half_width / across;
    result.edge = { std::min(edge, beside), std::max(edge, beside) };
    return result;
  }

  /// Cut at the flanks' edges, then measured: all of it in the slice's own coordinates x, y.
  void MeshPosition::add_cells(const Slice &slice, const int slice_index, const double middle,
                               const double half_width, const int across,
                               std::vector<ContactCell> &cells) const
  {
    const double half_generator = slice.height / 2 / pinion_.cos_base_helix();
    const auto pinion_q = [&](const double x, const double y) {
      return pinion_.roll_squared(slice.pinion_roll, x, y);
    };
    const auto gear_q = [&](const double x, const double y) {
      return gear_.roll_squared(slice.gear_roll, -x, -y); // it faces the pinion
    };
    const auto axial = [&](const double y) { return slice.z + y * pinion_.cos_base_helix(); };
    const double limits[4] = { square(end_roll(pair_.pinion)), square(pair_.pinion.form_roll),
                               square(end_roll(pair_.gear)), square(pair_.gear.form_roll) };

    const Borders borders = borders_of_cells(slice, middle, half_width, across);
    for (int c = 0; c < across; ++c)
      {
        const double low = borders.at[c], high = borders.at[c + 1];
        Polygon polygon = { { low, -half_generator },
                            { high, -half_generator },
                            { high, half_generator },
                            { low, half_generator } };
        bool cut = false;
        for (int edge = 0; edge < 4 && !polygon.empty(); ++edge)
          {
            // Positive inside; linear between corners, which is how an edge runs over a cell.
            const auto inside = [&](const Eigen::Vector2d &p) {
              const double q = edge < 2 ? pinion_q(p.x(), p.y()) : gear_q(p.x(), p.y());
              return edge % 2 == 0 ? limits[edge] - q : q - limits[edge];
            };
            cut = cut || std::any_of(polygon.begin(), polygon.end(),
                                     [&](const Eigen::Vector2d &p) { return inside(p) < 0; });
            polygon = clip(polygon, inside);
          }
        if (polygon.size() < 3)
          continue;
        const auto [area, centre, half] = equal_rectangle(polygon);
        if (area < 0.02 * (high - low) * 2 * half_generator)
          continue; // a sliver below a fiftieth of a cell: its pressure would be noise, its load is nothing

        ContactCell cell;
        const bool is_beside_edge = centre.x() > borders.edge[0] && centre.x() < borders.edge[1],
                   at_tip = cut || slice.tip_edge || is_beside_edge,
                   on_rounding = !cut && slice.rounded && slice.end_power == 0;
        cell.slice = slice_index;
        cell.area = area;
        cell.lever = slice.lever;
        cell.cut_short = cut || slice.tip_edge;
        cell.window_border = (c == 0 || c == across - 1) && !cut;
        cell.place = on_rounding                ? CellPlace::rounded_tip
                     : at_tip && slice.face_end ? CellPlace::corner
                     : at_tip                   ? CellPlace::tip_edge
                     : slice.end_power < 0      ? CellPlace::face_end
                     : slice.face_end           ? CellPlace::finite_end
                                                : CellPlace::inside;
        cell.pinion = { .tooth = slice.pair,
                        .outline = {},
                        .roll = std::sqrt(std::max(0.0, pinion_q(centre.x(), centre.y()))),
                        .z = axial(centre.y()),
                        .half_profile = half.x(),
                        .half_generator = half.y() };
        cell.gear = { .tooth = -slice.pair,
                      .outline = {},
                      .roll = std::sqrt(std::max(0.0, gear_q(centre.x(), centre.y()))),
                      .z = gear_z_ - axial(centre.y()),
                      .half_profile = half.x(),
                      .half_generator = half.y() };
        cell.tilt = tilt_levers(slice, cell.pinion.roll, cell.pinion.z);
        for (const Eigen::Vector2d &p : polygon)
          {
            cell.pinion.outline.emplace_back(pinion_q(p.x(), p.y()), axial(p.y()));
            cell.gear.outline.emplace_back(gear_q(p.x(), p.y()), gear_z_ - axial(p.y()));
          }
        cell.gap = 0;
        for (const FacingPoints &points : gauss_points(slice, centre, half))
          cell.gap += 0.25 * gap(slice, points);
        cells.push_back(std::move(cell));
      }
  }

  FacingPoints MeshPosition::facing_at(const Slice &slice, const double x, const double y) const
  {
    const double q = pinion_.roll_squared(slice.pinion_roll, x, y);
    return facing(slice.pair, std::sqrt(std::max(0.0, q)), slice.z + y * pinion_.cos_base_helix());
  }

  std::array<FacingPoints, 4> MeshPosition::gauss_points(const Slice &slice, const Eigen::Vector2d &centre,
                                                         const Eigen::Vector2d &half) const
  {
    std::array<FacingPoints, 4> points;
    std::size_t n = 0;
    for (const double u : gauss(2).point)
      for (const double v : gauss(2).point)
        points[n++] =
            facing_at(slice, centre.x() + (2 * u - 1) * half.x(), centre.y() + (2 * v - 1) * half.y());
    return points;
  }

  double MeshPosition::removed_derivative(const FacingPoints &points, const std::size_t parameter) const
  {
    const double z = z_sign_ * points.z;
    const auto sum = [&](const FlankDeviations &flank, const double roll, const double own_z) {
      double result = 0;
      for (const ModificationParameter &acting : flank.parameters[parameter])
        result += acting.scale.slope(acting.value) * acting.modification->derivative(acting.by, roll, own_z);
      return result;
    };
    return sum(deviations_.pinion, points.pinion_roll, z) +
           sum(deviations_.gear, points.gear_roll, z - pair_.data.axial_offset);
  }

  double MeshPosition::gap_derivative(const Slice &slice, const ContactCell &cell,
                                      const std::size_t parameter) const
  {
    const double y = (cell.pinion.z - slice.z) / pinion_.cos_base_helix();
    const double x = profile_length(slice.pinion_roll + y * pinion_.roll_per_generator(), cell.pinion.roll,
                                    pair_.pinion.base_radius);
    double sum = 0;
    for (const FacingPoints &points :
         gauss_points(slice, { x, y }, { cell.pinion.half_profile, cell.pinion.half_generator }))
      sum += 0.25 * removed_derivative(points, parameter);
    return sum;
  }
} // namespace flank
