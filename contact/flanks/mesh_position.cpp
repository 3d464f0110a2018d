// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/flanks/mesh_position.hpp"

#include "mesh/base/gauss.hpp"
#include "mesh/base/least.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace flank
{
  namespace
  {
    constexpr double nowhere = 1e300; ///< gap where no points of the flanks face each other [mm]

    double square(const double v)
    {
      return v * v;
    }

    /// Where contact on a flank can end: at the end of the involute, or on its rounding (before the arc turns
    /// to the tip circle).
    double end_roll(const Gear &gear)
    {
      return gear.tip_rounding > 0
                 ? std::min(gear.tip_roll,
                            std::sqrt(roll_squared_at(square(gear.usable_tip_roll), 0.9 * gear.tip_rounding,
                                                      gear.base_radius)))
                 : gear.usable_tip_roll;
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

    /// Least value of a function of one variable, first sampled, then by Brent's method around the best
    /// sample; returns where.
    template <class Function>
    std::pair<double, double> least(const Function &function, const double low, const double high,
                                    const int samples)
    {
      int best = 0;
      double value = nowhere;
      for (int i = 0; i <= samples; ++i)
        if (const double v = function(low + (high - low) * i / samples); v < value)
          value = v, best = i;
      constexpr int bits = 26; // of the place; the value then has twice as many
      const double step = (high - low) / samples, at = low + best * step;
      const auto refined = least_between(function, std::max(low, at - step), std::min(high, at + step), bits);
      return refined.second < value ? refined : std::pair(at, value);
    }
  } // namespace

  double canonical_z_sign(const PairData &data)
  {
    // right/ccw: as it is; left/cw: mirrored in y; left/ccw: mirrored in z; right/cw: turned about x.
    // A spur pair is the limit of a right-hand pinion.
    return (data.helix_angle == 0 || data.pinion_hand == Hand::right) == data.counter_clockwise_drive ? 1
                                                                                                      : -1;
  }

  MeshPosition::MeshPosition(const GearPair &pair, const MeshDeviations &deviations, const double phase)
      : pair_(pair)
      , deviations_(deviations)
      , tan_pressure_angle_(std::tan(pair.working_pressure_angle))
      , phase_(phase)
      , z_sign_(canonical_z_sign(pair.data))
      , face_low_(z_sign_ > 0 ? pair.face_low : -pair.face_high)
      , face_high_(z_sign_ > 0 ? pair.face_high : -pair.face_low)
      , gear_z_(z_sign_ * pair.data.axial_offset)
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
             pinion_.cos_base_helix() * on_gear.distance + rounding_drop(pair_.pinion, pinion_roll) +
                 rounding_drop(pair_.gear, on_gear.roll) };
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

  /// Half a module to either side of the closest point: as far as a relief can push the contact.
  void MeshPosition::find_touch(Slice &slice) const
  {
    const double range = 0.5 * pair_.data.transverse_module;
    const auto value = [&](const double x) {
      const FacingPoints points = facing_at(slice, x, 0);
      return on_flanks(points) ? gap(slice, points) : nowhere;
    };
    std::tie(slice.touch_offset, slice.touch) =
        least(value, -range, range, 60); // a sample lies on the closest point
  }

  /// Moves a tip-edge slice from the end of the involute onto the rounding that follows it.
  void MeshPosition::place_on_rounding(Slice &slice) const
  {
    const bool pinion_tip = slice.pinion_roll >= pair_.pinion.usable_tip_roll;
    const Gear &gear = pinion_tip ? pair_.pinion : pair_.gear;
    if (gear.tip_rounding == 0)
      return;
    const double along =
        profile_length(gear.usable_tip_roll, end_roll(gear), gear.base_radius) * (pinion_tip ? 1 : -1);
    const auto pinion_roll_at = [&, start = slice.pinion_roll](const double x) {
      return std::sqrt(std::max(0.0, pinion_.roll_squared(start, x, 0)));
    };
    const double x =
        least([&](const double v) { return facing(slice.pair, pinion_roll_at(v), slice.z).separation; },
              std::min(0.0, along), std::max(0.0, along), 30)
            .first;
    const FacingPoints points = facing(slice.pair, pinion_roll_at(x), slice.z);
    slice.pinion_roll = points.pinion_roll;
    slice.gear_roll = points.gear_roll;
  }

  std::vector<Slice> MeshPosition::slices(const int per_face_width) const
  {
    std::vector<Slice> all;
    const double height = (face_high_ - face_low_) / per_face_width;
    const int range = static_cast<int>(std::ceil(pair_.total_contact_ratio())) + 2;
    for (int k = -range; k <= range; ++k)
      for (int s = 0; s < per_face_width; ++s)
        if (std::optional<Slice> slice = slice_at(k, face_low_ + (s + 0.5) * height))
          {
            slice->number = static_cast<int>(all.size());
            slice->height = height;
            slice->face_end = s == 0 || s == per_face_width - 1;
            all.push_back(*slice);
          }
    return all;
  }

  double MeshPosition::beyond_path(const int pair, const double z) const
  {
    const double roll = contact_roll(pair, z);
    return std::max(roll - pair_.pinion.usable_tip_roll, (mate_roll(roll) - pair_.gear.usable_tip_roll) *
                                                             pair_.gear.base_radius /
                                                             pair_.pinion.base_radius);
  }

  std::pair<std::vector<Slice>, int> MeshPosition::slices_finer_at_corners(const int per_face_width) const
  {
    const std::vector<Slice> all = slices(per_face_width);
    const double face = face_high_ - face_low_, per_width = std::abs(pinion_.roll_per_generator()) * face /
                                                            pinion_.cos_base_helix(); // of the contact's roll
    const int undivided = static_cast<int>(all.size());
    if (per_width == 0)
      return { all, undivided }; // a spur gear's line has no corner
    std::vector<Slice> result;
    const std::function<void(const Slice &, int)> add = [&](const Slice &slice, const int times) {
      if (times == 0)
        result.push_back(slice);
      else
        for (const Slice &half : halves(slice, undivided))
          add(half, times - 1);
    };
    constexpr double by_chance = 1e-6; // no line is as long or ends there by its makers' round numbers
    for (const Slice &slice : all)
      {
        // Over the width of the face the contact moves on by per_width.
        const double length =
            -std::min(beyond_path(slice.pair, face_low_), beyond_path(slice.pair, face_high_)) / per_width;
        const bool is_near = beyond_path(slice.pair, slice.z) < (0.1 + by_chance) * per_width;
        add(slice, !is_near || length > 0.2 + by_chance ? 0 : length > 0.1 + by_chance ? 1 : 2);
      }
    return { result, undivided };
  }

  std::vector<Slice> MeshPosition::halves(const Slice &slice, const int undivided) const
  {
    std::vector<Slice> result;
    for (const int upper : { 0, 1 })
      if (std::optional<Slice> half = slice_at(slice.pair, slice.z + (upper - 0.5) * slice.height / 2))
        {
          half->number = undivided + 2 * slice.number + upper; // every number from `undivided` on, once
          half->height = slice.height / 2;
          const double end = upper == 1 ? face_high_ : face_low_;
          half->face_end = slice.face_end && std::abs(half->z - end) < 0.75 * half->height;
          result.push_back(*half);
        }
    return result;
  }

  std::optional<Slice> MeshPosition::slice_at(const int pair, const double z) const
  {
    const Gear &pinion = pair_.pinion, &gear = pair_.gear;
    const double cos_bb = pinion_.cos_base_helix(), alpha = pair_.working_pressure_angle;
    const double roll = contact_roll(pair, z), mate = mate_roll(roll);
    if (roll > pinion.usable_tip_roll + pinion.pitch_angle() ||
        mate > gear.usable_tip_roll + gear.pitch_angle())
      return std::nullopt; // more than a pitch away from the path of action
    Slice slice{};
    slice.pair = pair;
    slice.z = z;
    slice.pinion_roll = roll;
    slice.gear_roll = mate;
    slice.normal_angle = -alpha;
    slice.lever = pinion.base_radius * cos_bb;
    slice.gear_lever = gear.base_radius * cos_bb;
    slice.tip_edge = roll > pinion.usable_tip_roll || mate > gear.usable_tip_roll;
    // Beyond the path of action the tip edge of one gear touches the other's involute.
    const auto at_tip = [&](const Gear &from, const Gear &onto, const double from_angle,
                            const double onto_angle, double &tip_roll, double &other_roll, double &lever) {
      tip_roll = from.usable_tip_roll;
      const Foot other = foot(from, onto, from_angle, onto_angle, tip_roll);
      other_roll = other.roll;
      slice.normal_angle = other.normal_angle;
      lever = cos_bb * other.arm;
      place_on_rounding(slice);
    };
    if (roll > pinion.usable_tip_roll)
      at_tip(pinion, gear, roll - alpha, mate - alpha, slice.pinion_roll, slice.gear_roll, slice.lever);
    else if (mate > gear.usable_tip_roll)
      at_tip(gear, pinion, mate - alpha, roll - alpha, slice.gear_roll, slice.pinion_roll, slice.gear_lever);
    if (slice.pinion_roll < pinion.form_roll || slice.gear_roll < gear.form_roll)
      return std::nullopt;
    slice.tilt = tilt_levers(slice, slice.pinion_roll, slice.z);
    find_touch(slice);
    if (slice.touch >= nowhere)
      return std::nullopt; // a tip so far from the other flank that no points of them face each other
    return slice;
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

    for (int c = 0; c < across; ++c)
      {
        const double low = middle + half_width * (2.0 * c / across - 1),
                     high = middle + half_width * (2.0 * (c + 1) / across - 1);
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
        const bool at_tip = cut || slice.tip_edge;
        cell.slice = slice_index;
        cell.area = area;
        cell.lever = slice.lever;
        cell.window_border = (c == 0 || c == across - 1) && !cut;
        cell.place = at_tip && slice.face_end ? CellPlace::corner
                     : at_tip                 ? CellPlace::tip_edge
                     : slice.face_end         ? CellPlace::face_end
                                              : CellPlace::inside;
        cell.pinion = { slice.pair,        {},       std::sqrt(pinion_q(centre.x(), centre.y())),
                        axial(centre.y()), half.x(), half.y() };
        cell.gear = {
          -slice.pair, {},      std::sqrt(gear_q(centre.x(), centre.y())), gear_z_ - axial(centre.y()),
          half.x(),    half.y()
        };
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

  std::pair<Slice, double> MeshPosition::first_touching(const int per_face_width, const int cycle) const
  {
    // A tip a pitch away can meet the other flank where the driver's rotation opens the gap: never touches.
    const auto rotation = [&](const Slice &slice) {
      return slice.lever > 0 ? (slice.touch + stand_back(slice.pair, cycle)) / slice.lever : nowhere;
    };
    const auto earlier = [&](const Slice &a, const Slice &b) { return rotation(a) < rotation(b); };
    const std::vector<Slice> all = slices(per_face_width);
    const Slice best = *std::min_element(all.begin(), all.end(), earlier);
    // Between the middles of its neighbours, or up to the end of the face.
    const auto value = [&](const double z) {
      const std::optional<Slice> slice = slice_at(best.pair, z);
      return slice ? rotation(*slice) : nowhere;
    };
    const auto [z, touching] = least(value, std::max(face_low_, best.z - best.height),
                                     std::min(face_high_, best.z + best.height), 4);
    return { *slice_at(best.pair, z), touching };
  }

  double MeshPosition::first_touch_derivative(const int per_face_width, const int cycle,
                                              const std::size_t parameter) const
  {
    const Slice slice = first_touching(per_face_width, cycle).first;
    return removed_derivative(facing_at(slice, slice.touch_offset, 0), parameter) / slice.lever;
  }
} // namespace flank
