// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/gear_pair.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/tooth_profile.hpp"

#include <fmt/format.h>

namespace flank
{
  namespace
  {
    using units::degree;

    [[noreturn]] void refuse(const Gear &gear, const char *quantity, const std::string &message)
    {
      throw InputError(message, gear.name + " " + quantity);
    }

    /// Where a chamfer or a rounding of the tip corner ends the involute. The rounding's centre lies `radius`
    /// inside the flank on its normal and `radius` below the tip circle: (r_a - rho)^2 = r_b^2 + (r_b roll -
    /// rho)^2.
    double usable_tip_roll(const Gear &gear)
    {
      const double base = gear.base_radius, rho = gear.tip_rounding;
      if (gear.tip_chamfer > 0 && rho > 0)
        refuse(gear, "tip rounding", "a tip corner is chamfered or rounded, not both; give one of the two");
      const double limit = 0.5 * (gear.tip_radius - std::max(base, gear.root_radius));
      if (gear.tip_chamfer > limit)
        refuse(gear, "tip chamfer",
               fmt::format("the chamfer takes more than half of the flank; at most {:.4f} mm", limit));
      if (rho > limit)
        refuse(gear, "tip rounding",
               fmt::format("the rounding takes more than half of the flank; at most {:.4f} mm", limit));
      if (rho > 0)
        return (std::sqrt((gear.tip_radius - rho - base) * (gear.tip_radius - rho + base)) + rho) / base;
      return roll_angle(gear.tip_radius - gear.tip_chamfer, base);
    }

    /// The involute and its tip; refuses what has none.
    void add_tooth(Gear &gear, const double half_pitch, const double pressure_angle,
                   const double normal_module, std::vector<std::string> &warnings)
    {
      if (gear.tooth_thickness <= 0 || gear.tooth_thickness >= 2 * half_pitch)
        refuse(gear, "tooth thickness",
               fmt::format("tooth thickness {:.4f} mm must lie between 0 and the transverse pitch {:.4f} mm",
                           gear.tooth_thickness, 2 * half_pitch));
      gear.half_angle_at_base = gear.tooth_thickness / (2 * gear.reference_radius) + involute(pressure_angle);
      if (gear.tip_radius <= gear.base_radius)
        refuse(gear, "tip diameter",
               fmt::format("tip diameter {:.4f} mm does not reach above the base circle {:.4f} mm: there is "
                           "no involute flank",
                           2 * gear.tip_radius, 2 * gear.base_radius));
      if (gear.root_radius >= gear.tip_radius)
        refuse(gear, "root diameter",
               fmt::format("root diameter {:.4f} mm must be less than the tip diameter {:.4f} mm",
                           2 * gear.root_radius, 2 * gear.tip_radius));
      gear.tip_roll = roll_angle(gear.tip_radius, gear.base_radius);
      gear.usable_tip_roll = usable_tip_roll(gear);
      gear.tip_thickness = 2 * gear.tip_radius * gear.flank().half_angle(gear.tip_roll);
      if (gear.tip_thickness <= 0.02 * normal_module)
        refuse(gear, "tip diameter",
               fmt::format("pointed tip: the tooth is {:.4f} mm thick at the tip circle, at least 0.02 of "
                           "the normal module is needed; "
                           "reduce the tip diameter",
                           gear.tip_thickness));
      if (gear.tip_thickness < 0.2 * normal_module)
        warnings.push_back(
            fmt::format("{}: thin tip, {:.3f} mm at the tip circle (below 0.2 of the normal module)",
                        gear.name, gear.tip_thickness));
    }

    void check_rim(const Gear &gear, const double normal_module, std::vector<std::string> &warnings)
    {
      const double rim = gear.root_radius - gear.bore_radius;
      if (gear.root_radius <= 0.6 * normal_module)
        refuse(gear, "root diameter",
               fmt::format("root diameter {:.4f} mm leaves no room for a bore inside a rim of half a normal "
                           "module ({:.4f} mm); it must be greater than {:.4f} mm",
                           2 * gear.root_radius, 0.5 * normal_module, 1.2 * normal_module));
      if (rim < 0.5 * normal_module)
        refuse(gear, "bore diameter",
               fmt::format("bore too large: the rim between bore and root circle is {:.4f} mm, at least half "
                           "a normal module ({:.4f} mm) "
                           "is needed; a bore diameter up to {:.3f} mm is allowed",
                           rim, 0.5 * normal_module, 2 * (gear.root_radius - 0.5 * normal_module)));
      // Meshes of smaller ones would be of arcs that geometry takes for points.
      constexpr double least = 1e-3;
      if (gear.bore_radius < least * gear.root_radius)
        refuse(gear, "bore diameter",
               fmt::format("a bore is at least {:g} of the root circle, {:.6g} mm in diameter; for a solid "
                           "gear that is clamped in its middle take a tenth of the root diameter",
                           least, 2 * least * gear.root_radius));
      if (gear.fillet_radius < least * normal_module)
        refuse(gear, "fillet radius",
               fmt::format("a fillet's radius is at least {:g} of the normal module, {:.6g} mm", least,
                           least * normal_module));
      if (rim < 2 * normal_module)
        warnings.push_back(fmt::format("{}: thin rim, {:.3f} mm under the root circle; the clamped bore then "
                                       "carries much of the stiffness",
                                       gear.name, rim));
    }

    /// Where the involute ends in the fillet; refuses fillets that do not fit.
    void add_fillet(Gear &gear)
    {
      const ToothProfile profile(gear);
      gear.form_radius = profile.form_radius();
      gear.form_roll = roll_angle(gear.form_radius, gear.base_radius);
      if (gear.form_radius >= gear.tip_radius)
        refuse(gear, "fillet radius",
               fmt::format("the fillet meets the flank at radius {:.4f} mm, above the tip circle {:.4f} mm; "
                           "reduce the fillet radius",
                           gear.form_radius, gear.tip_radius));
      if (profile.root_land_angle() < 0)
        refuse(gear, "fillet radius",
               fmt::format("fillets of neighbouring teeth overlap by {:.4f} deg at the root circle; reduce "
                           "the fillet radius (now {:.4f} "
                           "mm, at most {:.4f} mm) or the root diameter",
                           -2 * profile.root_land_angle() / degree, gear.fillet_radius,
                           largest_fillet_radius(gear)));
    }

    /// A rack of tip radius rho whose straight flank reaches below the interference point undercuts.
    void warn_of_undercut(const Gear &gear, const double pressure_angle, std::vector<std::string> &warnings)
    {
      const double straight_depth =
          gear.reference_radius - gear.root_radius - gear.fillet_radius * (1 - std::sin(pressure_angle));
      const double allowed_depth = gear.reference_radius * std::pow(std::sin(pressure_angle), 2);
      if (straight_depth > allowed_depth)
        warnings.push_back(fmt::format("{}: a generating rack would undercut this tooth (straight depth "
                                       "{:.3f} mm below the reference circle, {:.3f} mm allowed); "
                                       "the flank is taken as a full involute to its form circle",
                                       gear.name, straight_depth, allowed_depth));
    }

    Gear make_gear(const GearData &data, const PairData &pair, const double normal_module,
                   std::vector<std::string> &warnings)
    {
      Gear gear;
      static_cast<GearData &>(gear) = data;

      const double pressure_angle = pair.transverse_pressure_angle;
      gear.helix_angle = pair.helix_angle;
      gear.reference_radius = pair.transverse_module * gear.teeth / 2;
      gear.base_radius = gear.reference_radius * std::cos(pressure_angle);
      gear.base_helix_angle = std::atan(std::tan(pair.helix_angle) * std::cos(pressure_angle));

      // Tooth thickness and profile shift follow from each other: s_t = m_t pi/2 + 2 x m_n tan(alpha_t).
      const double half_pitch = pair.transverse_module * units::pi / 2;
      if (std::isnan(gear.tooth_thickness))
        gear.tooth_thickness = half_pitch + 2 * gear.profile_shift * normal_module * std::tan(pressure_angle);
      else
        gear.profile_shift =
            (gear.tooth_thickness - half_pitch) / (2 * normal_module * std::tan(pressure_angle));
      if (std::isnan(gear.tip_radius))
        gear.tip_radius = gear.reference_radius + normal_module * (1 + gear.profile_shift);
      if (std::isnan(gear.root_radius))
        gear.root_radius = gear.reference_radius - normal_module * (1.25 - gear.profile_shift);

      add_tooth(gear, half_pitch, pressure_angle, normal_module, warnings);
      check_rim(gear, normal_module, warnings);
      add_fillet(gear);
      warn_of_undercut(gear, pressure_angle, warnings);
      return gear;
    }

    RollAngles roll_angles(const Gear &gear, const Gear &mate, const GearPair &pair)
    {
      const double base_pitch_roll = gear.pitch_angle(); // p_bt / r_b
      RollAngles roll;
      roll.tip = gear.usable_tip_roll;
      roll.start_of_active_profile = pair.facing_roll(gear, mate, mate.usable_tip_roll);
      roll.pitch_point = std::tan(pair.working_pressure_angle);
      roll.lowest_single_contact = roll.tip - base_pitch_roll;
      roll.highest_single_contact = roll.start_of_active_profile + base_pitch_roll;
      return roll;
    }

    void check_mesh(const Gear &gear, const Gear &mate, const RollAngles &roll, const double clearance,
                    const double normal_module, std::vector<std::string> &warnings)
    {
      if (roll.start_of_active_profile <= 0)
        refuse(mate, "tip diameter",
               fmt::format("contact below the base circle of the {}: the tip of the {} reaches {:.4f} mm "
                           "past the end of the line of "
                           "action; reduce its tip diameter",
                           gear.name, mate.name, -roll.start_of_active_profile * gear.base_radius));
      if (roll.start_of_active_profile < gear.form_roll)
        refuse(mate, "tip diameter",
               fmt::format("interference: the tip of the {} meets the {} at roll angle {:.4f} deg, inside "
                           "its fillet that ends at {:.4f} "
                           "deg (diameter {:.4f} mm); "
                           "reduce this tip diameter, or the root diameter or fillet radius of the {}",
                           mate.name, gear.name, roll.start_of_active_profile / degree,
                           gear.form_roll / degree, 2 * gear.form_radius, gear.name));
      if (clearance <= 0)
        refuse(gear, "tip diameter",
               fmt::format("the tip of the {} touches the root circle of the {}: tip clearance {:.4f} mm",
                           gear.name, mate.name, clearance));
      if (clearance < 0.1 * normal_module)
        warnings.push_back(fmt::format("{}: tip clearance {:.4f} mm is below 0.1 of the normal module",
                                       gear.name, clearance));
    }

    /// Refuses what does not mesh; warns of what hardly does.
    void check_pair(GearPair &pair)
    {
      if (pair.length_of_action <= 0)
        throw InputError(
            fmt::format(
                "the teeth do not reach each other: length of action {:.4f} mm; reduce the centre distance",
                pair.length_of_action),
            "centre distance");
      check_mesh(pair.pinion, pair.gear, pair.pinion_roll, pair.pinion_tip_clearance, pair.normal_module,
                 pair.warnings);
      check_mesh(pair.gear, pair.pinion, pair.gear_roll, pair.gear_tip_clearance, pair.normal_module,
                 pair.warnings);
      if (pair.backlash < 0)
        throw InputError(
            fmt::format("no backlash: the teeth jam by {:.3g} mm at the pitch circles; reduce the "
                        "tooth thicknesses or increase the centre distance",
                        -pair.backlash),
            "centre distance");
      if (pair.total_contact_ratio() < 1)
        throw InputError(
            fmt::format("the total contact ratio is {:.4f}: below 1 the mesh loses contact during the cycle",
                        pair.total_contact_ratio()),
            "centre distance");
      if (pair.transverse_contact_ratio < 1.1)
        pair.warnings.push_back(
            fmt::format("transverse contact ratio {:.4f} is below 1.1", pair.transverse_contact_ratio));
      if (pair.common_face_width < std::max(pair.pinion.face_width, pair.gear.face_width))
        pair.warnings.push_back(fmt::format(
            "the faces do not cover each other: widths {:.3f} and {:.3f} mm, offset {:.3f} mm; contact from "
            "z = {:.3f} to {:.3f} mm",
            pair.pinion.face_width, pair.gear.face_width, pair.data.axial_offset, pair.face_low,
            pair.face_high));
    }
  } // namespace

  GearPair make_gear_pair(const PairData &data)
  {
    GearPair pair;
    pair.data = data;
    pair.normal_module = data.transverse_module * std::cos(data.helix_angle);
    pair.normal_pressure_angle =
        std::atan(std::tan(data.transverse_pressure_angle) * std::cos(data.helix_angle));
    pair.pinion = make_gear(data.pinion, data, pair.normal_module, pair.warnings);
    pair.gear = make_gear(data.gear, data, pair.normal_module, pair.warnings);
    Gear &pinion = pair.pinion, &gear = pair.gear;

    const double base_sum = pinion.base_radius + gear.base_radius;
    if (data.centre_distance <= base_sum)
      throw InputError(
          fmt::format("the base circles overlap: the centre distance must be greater than {:.4f} mm",
                      base_sum),
          "centre distance");
    pair.working_pressure_angle = std::acos(base_sum / data.centre_distance);
    pair.base_helix_angle = pinion.base_helix_angle;
    pair.line_of_action = data.centre_distance * std::sin(pair.working_pressure_angle);
    pair.transverse_base_pitch = pinion.base_radius * pinion.pitch_angle();
    pair.length_of_action = pinion.base_radius * pinion.usable_tip_roll +
                            gear.base_radius * gear.usable_tip_roll - pair.line_of_action;
    pair.face_low = std::max(-pinion.face_width / 2, data.axial_offset - gear.face_width / 2);
    pair.face_high = std::min(pinion.face_width / 2, data.axial_offset + gear.face_width / 2);
    pair.common_face_width = pair.face_high - pair.face_low;
    if (pair.common_face_width <= 0)
      throw InputError(fmt::format("the gears stand beside each other: face widths {:.4f} and {:.4f} mm "
                                   "leave {:.4f} mm between them",
                                   pinion.face_width, gear.face_width, -pair.common_face_width),
                       "axial offset");
    pair.transverse_contact_ratio = pair.length_of_action / pair.transverse_base_pitch;
    pair.overlap_ratio =
        pair.common_face_width * std::tan(pair.base_helix_angle) / pair.transverse_base_pitch;
    pair.pinion_tip_clearance = data.centre_distance - pinion.tip_radius - gear.root_radius;
    pair.gear_tip_clearance = data.centre_distance - gear.tip_radius - pinion.root_radius;

    const auto working_thickness = [&](const Gear &g) {
      return 2 * data.centre_distance * g.base_radius / base_sum *
             (g.half_angle_at_base - involute(pair.working_pressure_angle));
    };
    const double working_pitch = 2 * units::pi * data.centre_distance / (pinion.teeth + gear.teeth);
    pair.backlash = working_pitch - working_thickness(pinion) - working_thickness(gear);
    // Nominal gears at their nominal distance have none: no jam by the rounding of that.
    constexpr double rounding = 1e-12;
    if (std::abs(pair.backlash) < rounding * data.centre_distance)
      pair.backlash = 0;

    pair.pinion_roll = roll_angles(pinion, gear, pair);
    pair.gear_roll = roll_angles(gear, pinion, pair);
    check_pair(pair);
    return pair;
  }
} // namespace flank
