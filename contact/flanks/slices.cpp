// SPDX-License-Identifier: GPL-2.0-or-later
// Where the slices of a mesh position lie: their closest points, what of them touches first.
#include "contact/flanks/mesh_position.hpp"

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

  /// Searches half a module to either side of the closest point, which is as far as a relief can push the
  /// contact.
  void MeshPosition::find_touch(Slice &slice) const
  {
    const double range = 0.5 * pair_.data.transverse_module;
    const auto value = [&](const double x) {
      if (pinion_.roll_squared(slice.pinion_roll, x, 0) < 0)
        return nowhere; // inside the base circle
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
    slice.rounded = pinion_.twist() == 0;
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

  void MeshPosition::mark_end(Slice &slice) const
  {
    const bool at_low = slice.z - face_low_ < 0.75 * slice.height,
               at_high = face_high_ - slice.z < 0.75 * slice.height;
    slice.face_end = at_low || at_high;
    slice.end_power = std::min(at_low ? end_powers_[0] : 0, at_high ? end_powers_[1] : 0);
  }

  std::vector<Slice> MeshPosition::slices(const int per_face_width) const
  {
    std::vector<Slice> all;
    const double height = (face_high_ - face_low_) / per_face_width;
    const int range = static_cast<int>(std::ceil(pair_.total_contact_ratio())) + 2;
    // The pair that meets in the middle of the common face, which may lie far from the pinion's own middle.
    const double pitches = 0.5 * (face_low_ + face_high_) * pinion_.twist() / pair_.pinion.pitch_angle();
    const int middle = -static_cast<int>(std::lround(pitches));
    for (int k = middle - range; k <= middle + range; ++k)
      for (int s = 0; s < per_face_width; ++s)
        if (std::optional<Slice> slice = slice_at(k, face_low_ + (s + 0.5) * height))
          {
            slice->number = static_cast<int>(all.size());
            slice->height = height;
            mark_end(*slice);
            all.push_back(*slice);
          }
    return all;
  }

  std::pair<double, double> MeshPosition::contact_line(const int pair) const
  {
    const double at_middle = contact_roll(pair, 0), twist = pinion_.twist(),
                 of_pinion_tip = (pair_.pinion.usable_tip_roll - at_middle) / twist,
                 of_gear_tip =
                     (pair_.facing_roll(pair_.pinion, pair_.gear, pair_.gear.usable_tip_roll) - at_middle) /
                     twist;
    return std::minmax(of_pinion_tip, of_gear_tip);
  }

  std::pair<std::vector<Slice>, int> MeshPosition::slices_finer_at_corners(const int per_face_width) const
  {
    const std::vector<Slice> all = slices(per_face_width);
    const int undivided = static_cast<int>(all.size());
    if (pinion_.twist() == 0)
      return { all, undivided }; // a spur gear's line has no corner
    std::vector<Slice> result;
    const std::function<void(const Slice &, int)> add = [&](const Slice &slice, const int times) {
      if (times == 0)
        result.push_back(slice);
      else
        for (const Slice &half : halves(slice, undivided))
          add(half, times - 1);
    };
    const double face = face_high_ - face_low_;
    constexpr double by_chance = 1e-6; // no line is as long or ends there by its makers' round numbers
    for (const Slice &slice : all)
      {
        const auto [low, high] = contact_line(slice.pair);
        const double beside = (0.1 + by_chance) * std::min(face, high - low),
                     length = std::min(high, face_high_) - std::max(low, face_low_);
        const bool is_at_corner = low < face_low_ || high > face_high_,
                   is_near = slice.z > low - beside && slice.z < high + beside;
        add(slice, !is_at_corner || !is_near || length > 2 * beside ? 0 : length > beside ? 1 : 2);
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
          mark_end(*half);
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

  double MeshPosition::stand_back(const Slice &slice, const int cycle) const
  {
    const StandBack back = stand_back(slice.pair, cycle);
    const double cos_bb = pinion_.cos_base_helix();
    return back.pinion * (slice.lever / (pair_.pinion.base_radius * cos_bb)) +
           back.gear * (slice.gear_lever / (pair_.gear.base_radius * cos_bb));
  }

  std::pair<Slice, double> MeshPosition::first_touching(const int per_face_width, const int cycle) const
  {
    // A tip a pitch away can meet the other flank where the driver's rotation opens the gap: never touches.
    const auto rotation = [&](const Slice &slice) {
      return slice.lever > 0 ? (slice.touch + stand_back(slice, cycle)) / slice.lever : nowhere;
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
