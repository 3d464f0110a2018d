// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/grid/mesh_position.hpp"

#include "mesh/base/gauss.hpp"

#include <cmath>

namespace flank
{
  double canonical_z_sign(const PairData &data)
  {
    // right/ccw: as it is; left/cw: mirrored in y; left/ccw: mirrored in z; right/cw: turned about x.
    return (data.pinion_hand == Hand::right) == data.counter_clockwise_drive ? 1 : -1;
  }

  MeshPosition::MeshPosition(const GearPair &pair, const FlankModifications &pinion, const FlankModifications &gear, const double phase)
      : pair_(pair)
      , pinion_modifications_(pinion)
      , gear_modifications_(gear)
      , phase_(phase)
      , z_sign_(canonical_z_sign(pair.data))
      , pinion_(pair.pinion.flank())
      , gear_(pair.gear.flank())
  {
  }

  double MeshPosition::contact_roll(const int pair, const double z) const
  {
    return std::tan(pair_.working_pressure_angle) + (phase_ + pair) * pair_.pinion.pitch_angle() + z * pinion_.twist();
  }

  /// Transverse distance from the point at `roll` of one involute to the other, along the tangent from the point to the
  /// other's base circle: exact, because the involute's normals are those tangents. Each gear in a frame at its own axis
  /// whose x axis points to the other's axis; the frames are half a turn apart.
  double MeshPosition::foot(const Gear &from, const Gear &onto, const double from_angle, const double onto_angle, const double roll,
                            double &onto_roll, double &arm) const
  {
    const double          sigma = from_angle - roll;
    const Eigen::Vector2d point =
        from.base_radius * Eigen::Vector2d(std::cos(sigma) - roll * std::sin(sigma), std::sin(sigma) + roll * std::cos(sigma));
    const Eigen::Vector2d seen(pair_.data.centre_distance - point.x(), -point.y());
    const double          tangent = std::sqrt(std::max(0.0, seen.squaredNorm() - onto.base_radius * onto.base_radius));
    const double          angle   = std::atan2(seen.y(), seen.x()) - std::atan2(tangent, onto.base_radius);
    onto_roll                     = onto_angle - angle;
    arm                           = point.x() * std::cos(angle) + point.y() * std::sin(angle); // of the other's normal about this axis
    return tangent - onto.base_radius * onto_roll;
  }

  double MeshPosition::gap(const int pair, const double pinion_roll, const double z, double &gear_roll) const
  {
    const double roll = contact_roll(pair, z), mate = (pair_.line_of_action - pair_.pinion.base_radius * roll) / pair_.gear.base_radius;
    double       arm;
    const double distance = foot(pair_.pinion, pair_.gear, roll - pair_.working_pressure_angle, mate - pair_.working_pressure_angle,
                                 pinion_roll, gear_roll, arm);
    return pinion_.cos_base_helix() * distance + removed(pinion_modifications_, pinion_roll, z_sign_ * z) +
           removed(gear_modifications_, gear_roll, z_sign_ * z);
  }

  double MeshPosition::modified_separation(const Slice &slice) const
  {
    return slice.separation + removed(pinion_modifications_, slice.pinion_roll, z_sign_ * slice.z) +
           removed(gear_modifications_, slice.gear_roll, z_sign_ * slice.z);
  }

  std::vector<Slice> MeshPosition::slices(const int per_face_width, const double reach) const
  {
    const Gear        &pinion = pair_.pinion, &gear = pair_.gear;
    const double       cos_bb = pinion_.cos_base_helix(), alpha = pair_.working_pressure_angle;
    std::vector<Slice> all;
    double             least  = 1e300;
    const double       height = pair_.common_face_width / per_face_width;
    const int          range  = static_cast<int>(std::ceil(pair_.total_contact_ratio())) + 2;
    for (int k = -range; k <= range; ++k)
      for (int s = 0; s < per_face_width; ++s)
        {
          Slice slice;
          slice.pair        = k;
          slice.z           = (s + 0.5) * height - pair_.common_face_width / 2;
          slice.height      = height;
          const double roll = contact_roll(k, slice.z), mate = (pair_.line_of_action - pinion.base_radius * roll) / gear.base_radius;
          slice.pinion_roll = roll;
          slice.gear_roll   = mate;
          slice.separation  = 0;
          slice.lever       = pinion.base_radius * cos_bb;
          slice.gear_lever  = gear.base_radius * cos_bb;
          slice.tip_edge    = roll > pinion.tip_roll || mate > gear.tip_roll;
          double arm;
          if (roll > pinion.tip_roll + pinion.pitch_angle() || mate > gear.tip_roll + gear.pitch_angle())
            continue; // more than a pitch away from the path of action
          if (roll > pinion.tip_roll)
            {
              slice.pinion_roll = pinion.tip_roll;
              slice.separation  = cos_bb * foot(pinion, gear, roll - alpha, mate - alpha, pinion.tip_roll, slice.gear_roll, arm);
              slice.lever       = cos_bb * arm;
            }
          else if (mate > gear.tip_roll)
            {
              slice.gear_roll  = gear.tip_roll;
              slice.separation = cos_bb * foot(gear, pinion, mate - alpha, roll - alpha, gear.tip_roll, slice.pinion_roll, arm);
              slice.gear_lever = cos_bb * arm;
            }
          if (slice.pinion_roll < pinion.form_roll || slice.gear_roll < gear.form_roll)
            continue;
          least = std::min(least, modified_separation(slice));
          all.push_back(slice);
        }
    std::erase_if(all, [&](const Slice &slice) { return modified_separation(slice) > least + reach; });
    return all;
  }

  double MeshPosition::relative_radius(const Slice &slice) const
  {
    return 1 / (pinion_.cos_base_helix() *
                (1 / (pair_.pinion.base_radius * slice.pinion_roll) + 1 / (pair_.gear.base_radius * slice.gear_roll)));
  }

  void MeshPosition::add_cells(const Slice &slice, const int slice_index, const double half_width, const int across, const bool face_end,
                               std::vector<ContactCell> &cells) const
  {
    const double rp = pair_.pinion.base_radius, rg = pair_.gear.base_radius, cp = pinion_.roll_per_generator(),
                 cg             = gear_.roll_per_generator();
    const double half_generator = slice.height / 2 / pinion_.cos_base_helix();
    const auto   square         = [](const double v) { return v * v; };
    const auto   pinion_q       = [&](const double x, const double y) { return square(slice.pinion_roll + y * cp) + 2 * x / rp; };
    const auto   gear_q         = [&](const double x, const double y) { return square(slice.gear_roll - y * cg) - 2 * x / rg; };
    const auto   axial          = [&](const double y) { return slice.z + y * pinion_.cos_base_helix(); };
    const double limits[4]      = { square(pair_.pinion.tip_roll), square(pair_.pinion.form_roll), square(pair_.gear.tip_roll),
                                    square(pair_.gear.form_roll) };

    for (int c = 0; c < across; ++c)
      {
        const double low = half_width * (2.0 * c / across - 1), high = half_width * (2.0 * (c + 1) / across - 1);
        Polygon      polygon = { { low, -half_generator }, { high, -half_generator }, { high, half_generator }, { low, half_generator } };
        bool         cut     = false;
        for (int edge = 0; edge < 4 && !polygon.empty(); ++edge)
          {
            // Positive inside; linear between corners, which is how an edge runs over a cell.
            const auto inside = [&](const Eigen::Vector2d &p) {
              const double q = edge < 2 ? pinion_q(p.x(), p.y()) : gear_q(p.x(), p.y());
              return edge % 2 == 0 ? limits[edge] - q : q - limits[edge];
            };
            cut     = cut || std::any_of(polygon.begin(), polygon.end(), [&](const Eigen::Vector2d &p) { return inside(p) < 0; });
            polygon = clip(polygon, inside);
          }
        if (polygon.size() < 3)
          continue;
        const auto [area, centre, half] = equal_rectangle(polygon);
        if (area < 0.02 * (high - low) * 2 * half_generator)
          continue; // a sliver below a fiftieth of a cell: its pressure would be noise, its load is nothing

        ContactCell cell;
        cell.slice         = slice_index;
        cell.area          = area;
        cell.lever         = slice.lever;
        cell.window_border = (c == 0 || c == across - 1) && !cut;
        cell.edge          = cut || slice.tip_edge || face_end;
        cell.pinion        = { slice.pair, {}, std::sqrt(pinion_q(centre.x(), centre.y())), axial(centre.y()), half.x(), half.y() };
        cell.gear          = { -slice.pair, {}, std::sqrt(gear_q(centre.x(), centre.y())), -axial(centre.y()), half.x(), half.y() };
        for (const Eigen::Vector2d &p : polygon)
          {
            cell.pinion.outline.emplace_back(pinion_q(p.x(), p.y()), axial(p.y()));
            cell.gear.outline.emplace_back(gear_q(p.x(), p.y()), -axial(p.y()));
          }
        cell.gap = 0;
        for (const double u : gauss(2).point)
          for (const double v : gauss(2).point)
            {
              const double x = centre.x() + (2 * u - 1) * half.x(), y = centre.y() + (2 * v - 1) * half.y();
              double       gear_roll;
              cell.gap += 0.25 * gap(slice.pair, std::sqrt(std::max(0.0, pinion_q(x, y))), axial(y), gear_roll);
            }
        cells.push_back(std::move(cell));
      }
  }

  double MeshPosition::first_touch(const int per_face_width) const
  {
    double least = 1e300;
    for (const Slice &slice : slices(per_face_width, 1e300))
      {
        least                 = std::min(least, modified_separation(slice) / slice.lever);
        constexpr int samples = 40; // along the profile around the closest point: relief may move the touching point
        for (int i = -samples; i <= samples; ++i)
          {
            const double roll =
                std::sqrt(std::max(0.0, slice.pinion_roll * slice.pinion_roll + 2 * (1.0 * i / samples) / pair_.pinion.base_radius));
            double gear_roll;
            if (roll < pair_.pinion.form_roll || roll > pair_.pinion.tip_roll)
              continue;
            const double value = gap(slice.pair, roll, slice.z, gear_roll);
            if (gear_roll <= pair_.gear.tip_roll && gear_roll >= pair_.gear.form_roll)
              least = std::min(least, value / slice.lever);
          }
      }
    return least;
  }
} // namespace flank
