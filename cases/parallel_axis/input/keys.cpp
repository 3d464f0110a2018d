// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/input/keys.hpp"

#include "cases/parallel_axis/pair/accuracy_level.hpp"

#include <fmt/ranges.h>

namespace flank
{
  namespace
  {
    using namespace keys;
    constexpr double least_length = 1e-3; // of what is made [mm]

    /// How the flanks of one gear are made: of both, or under left_flank and right_flank of one.
    std::vector<Key> flank_keys()
    {
      const double most = 1e4;
      std::vector<Key> keys;
      const auto start = [&](const std::string &table, const std::string &where) {
        keys.push_back(
            number(table + "start_roll_angle_deg", 0, 90, "one of three", "roll angle " + where + " [deg]"));
        keys.push_back(number(table + "start_diameter_mm", least_length, 1e5, "one of three",
                              "the same as a diameter [mm]"));
        keys.push_back(number(table + "start_length_of_roll_mm", 0, 1e5, "one of three",
                              "the same as base radius times roll angle [mm]"));
      };
      const auto shape = [&](const std::string &table) {
        keys.push_back(text(table + "shape", "linear", "how it grows", { "linear", "quadratic" }));
        keys.push_back(number(table + "blend_radius_mm", 0, 1e6, "0",
                              "of the arc that rounds the start of a linear relief, as grinding leaves it: "
                              "without it the pressure there has no bound [mm]"));
      };
      keys.push_back(number("tip_relief.amount_um", 0, most, "0",
                            "removed where the flank ends at the tip, normal to the flank [um]"));
      start("tip_relief.", "where it starts");
      shape("tip_relief.");
      keys.push_back(
          number("root_relief.amount_um", 0, most, "0", "removed at the start of active profile [um]"));
      start("root_relief.", "where it starts, going down");
      shape("root_relief.");
      keys.push_back(number("profile_slope.amount_um", -most, most, "0",
                            "over the active profile, nothing in its middle; > 0: less at the tip [um]"));
      keys.push_back(number("profile_crown.amount_um", -most, most, "0",
                            "removed at both ends of the active profile, quadratic [um]"));
      keys.push_back(
          number("lead_crown.amount_um", -most, most, "0", "h (2 z/b)^2: removed at the face ends [um]"));
      keys.push_back(number("helix_slope.amount_um", -most, most, "0",
                            "a z/b: removed over the face width, > 0: at +z; nothing at mid-face [um]"));
      keys.push_back(number("end_relief.amount_um", 0, most, "0", "removed at the face end [um]"));
      keys.push_back(number("end_relief.length_mm", least_length, 1e4, "required with the amount",
                            "from the face end to where it starts [mm]"));
      keys.push_back(
          text("end_relief.end", "both", "which face end", { "both", "negative_z", "positive_z" }));
      shape("end_relief.");
      keys.push_back(integer("bias[].corner", 1, 4, "required",
                             "1, 2: tip; 3, 4: root; 1 and 3 bias-in (1: where contact leaves the driving "
                             "tip), 2 and 4 bias-out"));
      keys.push_back(number("bias[].amount_um", 0, most, "required", "removed in the corner [um]"));
      start("bias[].", "at the face end where it starts");
      keys.push_back(number("bias[].length_mm", least_length, 1e4, "required",
                            "along the tip or root edge, from the face end [mm]"));
      shape("bias[].");
      keys.push_back(text("topography.file", "none",
                          "CSV table of what is removed over roll angle and face position; path from the "
                          "case file's folder"));
      keys.push_back(numbers("index_errors_um", -most, most, "none",
                             "how far each tooth stands back, normal to the flank, in the order of meshing; "
                             "as many as teeth [um]"));
      keys.push_back(number("runout.amount_um", 0, most, "0", "F_r: twice the eccentricity [um]"));
      keys.push_back(number("runout.angle_deg", -360, 360, "0",
                            "rotation since phase 0 at which the flanks stand back most [deg]"));
      return keys;
    }

    /// The beginning of the keys that belong to one list with a key, or say the same in another way.
    std::string of_list(const std::string &path)
    {
      if (const auto bracket = path.find('['); bracket != std::string::npos)
        return path.substr(0, bracket + 1);
      if (const auto start = path.find(".start_"); start != std::string::npos)
        return path.substr(0, start + 7);
      if (path.find(".tip_edge.") != std::string::npos)
        return "gear.tip_edge.";
      return path;
    }

    /// The beginnings of the keys that say what a key of [gear] says in another way, belong to one list with
    /// it, or say it of both flanks, where it is of one.
    std::vector<std::string> rivals(const std::string &path)
    {
      for (const std::string flank : { "gear.left_flank.", "gear.right_flank." })
        if (path.starts_with(flank))
          {
            const std::string of_both = "gear." + path.substr(flank.size());
            return { of_list(path), of_both.substr(0, of_both.find_first_of(".[", 5)) };
          }
      return { of_list(path) };
    }

    /// A value a level of accuracy, the coarsest first.
    template <class Value>
    auto of_levels(const Value &value)
    {
      std::vector<decltype(value(accuracy_levels().front()))> values;
      for (const AccuracyLevel &level : accuracy_levels())
        values.push_back(value(level));
      return values;
    }

    /// The fallback of a key that the level sets.
    template <class Value>
    std::string by_accuracy(const Value &value)
    {
      return fmt::format("by accuracy: {}", fmt::join(of_levels(value), ", "));
    }

    std::vector<Key> accuracy_keys()
    {
      return {
        text("accuracy", "standard",
             "element mesh, contact grid and near-field quadratures: what their own keys do not set",
             of_levels([](const AccuracyLevel &level) { return level.name; })),
        number(
            "accuracy.mean_te_percent", 0.05, 50, "none",
            "instead of a level: what the error estimate may state of the mean transmission error, at every "
            "torque [%]; level, contact grid and positions are made as fine as that takes"),
      };
    }

    std::vector<Key> axes_keys()
    {
      return {
        number("pair.centre_distance_mm", least_length, 1e5, "required", "centre distance [mm]"),
        number("pair.transverse_module_mm", least_length, 1e3, "or normal_module_mm",
               "transverse module [mm]"),
        number("pair.normal_module_mm", least_length, 1e3, "or transverse_module_mm", "normal module [mm]"),
        number("pair.transverse_pressure_angle_deg", 5, 45, "or normal_pressure_angle_deg",
               "transverse pressure angle at the reference circle [deg]"),
        number("pair.normal_pressure_angle_deg", 5, 45, "or transverse_pressure_angle_deg",
               "normal pressure angle at the reference cylinder [deg]"),
        number("pair.helix_angle_deg", 0, 45, "0", "helix angle at the reference cylinder [deg]; 0: spur"),
        text("pair.pinion_hand", "right", "hand of the pinion's helix", { "right", "left" }),
        number("pair.centre_distance_error_um", -1e4, 1e4, "0", "added to the centre distance [um]"),
        number("pair.axial_offset_mm", -1e4, 1e4, "0", "z of the gear's mid-face; the pinion's is 0 [mm]"),
        number("misalignment.in_plane_um", -1e4, 1e4, "0",
               "tilt of the axes in the plane of action, over the common face width; > 0: the gap opens "
               "towards +z [um]"),
        number("misalignment.in_plane_mrad", -100, 100, "or in_plane_um", "the same as an angle [mrad]"),
        number(
            "misalignment.across_plane_um", -1e4, 1e4, "0",
            "tilt at right angles to the plane of action, over the common face width; > 0: towards the mate "
            "at +z [um]"),
        number("misalignment.across_plane_mrad", -100, 100, "or across_plane_um",
               "the same as an angle [mrad]"),
      };
    }

    std::vector<Key> gear_keys(const std::string &gear)
    {
      std::vector<Key> all;
      if (gear == "gear")
        all.push_back(text("gear.like", "",
                           "\"pinion\": every key of [gear] that is left out is copied from [pinion]",
                           { "pinion" }));
      const auto add = [&](Key key) {
        key.path = gear + "." + key.path;
        all.push_back(std::move(key));
      };
      add(integer("teeth", 6, 1000, "required", "number of teeth"));
      add(number("face_width_mm", least_length, 1e4, "required", "face width, centred on z = 0 [mm]"));
      add(number("tip_diameter_mm", least_length, 1e5, "d + 2 m_n (1 + x)", "tip diameter [mm]"));
      add(number("root_diameter_mm", least_length, 1e5, "d - 2 m_n (1.25 - x)", "root diameter [mm]"));
      add(number("tooth_thickness_mm", least_length, 1e4, "from profile_shift",
                 "transverse tooth thickness, arc at the reference circle [mm]"));
      add(number("profile_shift", -2, 2, "0, or from tooth_thickness_mm",
                 "profile shift coefficient x, of the normal module [-]"));
      add(number("bore_diameter_mm", least_length, 1e5, "required",
                 "bore diameter, where the body is clamped [mm]"));
      add(number("fillet_radius_mm", least_length, 1e3, "required", "root fillet radius [mm]"));
      add(number("youngs_modulus_GPa", 1e-6, 1e4, "required", "Young's modulus [GPa]"));
      add(number("poissons_ratio", 0, 0.4999, "required", "Poisson's ratio [-]"));
      add(number("tip_edge.chamfer_mm", 0, 1e3, "0",
                 "radial height of a chamfer of the tip corner, at 45 degrees: the flank ends below it "
                 "[mm]"));
      add(number("tip_edge.rounding_radius_mm", 0, 1e3, "0",
                 "radius of the rounding of the tip corner [mm]"));
      for (const std::string flank : { "", "left_flank.", "right_flank." })
        for (Key key : flank_keys())
          {
            key.path = gear + "." + flank + key.path;
            key.listed = gear == "pinion" && flank.empty();
            all.push_back(std::move(key));
          }
      return all;
    }

    std::vector<Key> mounting_keys()
    {
      std::vector<Key> all;
      for (const std::string gear : { "pinion", "gear" })
        for (const auto &[key, meaning] :
             { std::pair{ "torsion", "turning of its hub" },
               { "tilt_in_plane", "tilting of its axis in the plane of action, at mid-face" },
               { "tilt_across_plane", "tilting of its axis at right angles to that" } })
          all.push_back(number("mounting." + gear + "_" + key + "_Nm_per_mrad", 1e-6, 1e12, "rigid",
                               std::string("linear spring against ") + meaning + " [N m/mrad]"));
      return all;
    }

    std::vector<Key> body_and_load_keys()
    {
      return {
        text("body.model", "ring",
             "elastic body, clamped at the bore: the whole gear, or some teeth around the loaded one",
             { "ring", "segment" }),
        integer("body.segment_teeth", 1, 999, "7",
                "teeth of a segment, odd; the loaded one is in the middle"),
        text("body.cut_faces", "free", "the two cut faces of a segment", { "free", "clamped" }),
        text("body.reduction", "automatic",
             "how the body is reduced to its flank: one tooth sector condensed by one process or by all "
             "ranks (automatic: by size), "
             "or all teeth at once (a check)",
             { "automatic", "condensed", "distributed", "direct" }),
        numbers("load.pinion_torque_Nm", 0, 1e9, "required", "pinion torques [N m]; 0: unloaded"),
        text("load.drive_flank", "counter_clockwise",
             "sense in which the pinion turns and drives, seen from +z",
             { "counter_clockwise", "clockwise" }),
        integer("mesh_cycle.positions", 2, 4096, "16", "mesh positions over one cycle"),
        text("mesh_cycle.period", "mesh", "how long: one mesh cycle, or until the same teeth meet again",
             { "mesh", "hunting" }),
        text("output.derivatives", "no",
             "yes: a study also gives exact derivatives by every parameter of the loaded flanks' "
             "modifications",
             { "no", "yes" }),
      };
    }

    std::vector<Key> mesh_and_contact_keys()
    {
      return {
        integer("mesh.degree", 1, 3, "by accuracy", "polynomial degree of the elements"),
        integer("mesh.flank_rows", 2, 200, "by accuracy", "elements along the involute"),
        integer("mesh.tooth_columns", 2, 100, "by accuracy", "elements across the tooth, even"),
        integer("mesh.face_layers", 1, 500, "by accuracy",
                "elements along the face width; longer ones in faces of more than 20 modules"),
        integer("mesh.fillet_rows", 1, 100, "by accuracy",
                "elements along the upper half of each root fillet"),
        integer("mesh.fillet_columns", 1, 100, "by accuracy",
                "elements along the lower half of each root fillet"),
        integer("mesh.rim_layers", 1, 200, "by accuracy, more to a small bore and in a thick rim",
                "elements from root to bore"),
        integer("contact_grid.slices", 1, 1001,
                by_accuracy([](const AccuracyLevel &level) { return level.grid.slices; }),
                "slices across the common face width (2N+1); short contacts have finer ones"),
        integer("contact_grid.profile_cells", 5, 101,
                by_accuracy([](const AccuracyLevel &level) { return level.grid.profile_cells; }),
                "cells across the profile in a slice (2M+1)"),
        text("contact.split", "projected", "how near and far field are joined", { "projected", "classical" }),
        integer("contact.near_field_points", 3, 8,
                by_accuracy([](const AccuracyLevel &level) { return level.near_field_points; }),
                "points of the near field's quadratures in each direction (projected split)"),
        text("contact.face_ends", "free",
             "ends and sharp tips of the flanks near the contact (projected split): free, as edges of "
             "elastic wedges; "
             "half_space: as if it went on, its tractions there taken off by the elements",
             { "free", "half_space" }),
        text("contact.classical_depth", "half_element", "matching depth of the classical split",
             { "half_element", "line_fit" }),
      };
    }
  } // namespace

  /// In the order in which users meet the keys.
  SceneKeys pair_keys()
  {
    std::vector<Key> keys;
    for (const std::vector<Key> &part :
         { accuracy_keys(), axes_keys(), gear_keys("pinion"), gear_keys("gear"), mounting_keys(),
           body_and_load_keys(), mesh_and_contact_keys() })
      keys.insert(keys.end(), part.begin(), part.end());
    const CopyRule like_pinion = {
      .key = "gear.like",
      .from = "pinion.",
      .to = "gear.",
      .rivals = rivals,
      .same = { { "gear.tooth_thickness_mm", "gear.profile_shift" } },
    };
    return {
      .scene = "parallel_axis",
      .keys = std::move(keys),
      .copy = { like_pinion },
      .note = "Every key of [pinion] that describes its flanks (from tip_relief to runout) exists under "
              "[gear], and for one flank alone "
              "under left_flank and right_flank, where it replaces that of both flanks; bias[]: a list of "
              "tables.",
    };
  }
} // namespace flank
