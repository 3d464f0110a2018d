// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace flank
{
  namespace
  {
    constexpr double unbounded = 1e300;

    Key text(std::string path, std::string fallback, std::string meaning, std::vector<std::string> choices = {})
    {
      return { std::move(path), Key::Type::text, 0, 0, false, std::move(fallback), std::move(meaning), std::move(choices), {}, true };
    }
    Key number(std::string path, double low, double high, std::string fallback, std::string meaning, bool low_open = false)
    {
      return { std::move(path), Key::Type::number, low, high, low_open, std::move(fallback), std::move(meaning), {}, {}, true };
    }
    Key integer(std::string path, double low, double high, std::string fallback, std::string meaning)
    {
      return { std::move(path), Key::Type::integer, low, high, false, std::move(fallback), std::move(meaning), {}, {}, true };
    }

    Key numbers(std::string path, double low, double high, std::string fallback, std::string meaning)
    {
      return { std::move(path), Key::Type::numbers, low, high, false, std::move(fallback), std::move(meaning), {}, {}, true };
    }

    Key texts(std::string path, std::string fallback, std::string meaning, std::vector<std::string> choices)
    {
      return { std::move(path), Key::Type::texts, 0, 0, false, std::move(fallback), std::move(meaning), std::move(choices), {}, true };
    }

    /// How the flanks of one gear are made: of both, or under left_flank and right_flank of one.
    std::vector<Key> flank_keys()
    {
      const double     most = 1e4;
      std::vector<Key> keys;
      const auto       start = [&](const std::string &table, const std::string &where) {
        keys.push_back(number(table + "start_roll_angle_deg", 0, 90, "one of three", "roll angle " + where + " [deg]"));
        keys.push_back(number(table + "start_diameter_mm", 0, 1e5, "one of three", "the same as a diameter [mm]", true));
        keys.push_back(number(table + "start_length_of_roll_mm", 0, 1e5, "one of three", "the same as base radius times roll angle [mm]"));
      };
      const auto shape = [&](const std::string &table) {
        keys.push_back(text(table + "shape", "linear", "how it grows", { "linear", "quadratic" }));
      };
      keys.push_back(number("tip_relief.amount_um", 0, most, "0", "removed where the flank ends at the tip, normal to the flank [um]"));
      start("tip_relief.", "where it starts");
      shape("tip_relief.");
      keys.push_back(number("root_relief.amount_um", 0, most, "0", "removed at the start of active profile [um]"));
      start("root_relief.", "where it starts, going down");
      shape("root_relief.");
      keys.push_back(
          number("profile_slope.amount_um", -most, most, "0", "over the active profile, nothing in its middle; > 0: less at the tip [um]"));
      keys.push_back(number("profile_crown.amount_um", -most, most, "0", "removed at both ends of the active profile, quadratic [um]"));
      keys.push_back(number("lead_crown.amount_um", -most, most, "0", "h (2 z/b)^2: removed at the face ends [um]"));
      keys.push_back(
          number("helix_slope.amount_um", -most, most, "0", "a z/b: removed over the face width, > 0: at +z; nothing at mid-face [um]"));
      keys.push_back(number("end_relief.amount_um", 0, most, "0", "removed at the face end [um]"));
      keys.push_back(number("end_relief.length_mm", 0, 1e4, "required with the amount", "from the face end to where it starts [mm]", true));
      keys.push_back(text("end_relief.end", "both", "which face end", { "both", "negative_z", "positive_z" }));
      shape("end_relief.");
      keys.push_back(integer("bias[].corner", 1, 4, "required",
                             "1, 2: tip; 3, 4: root; 1 and 3 bias-in (1: where contact leaves the driving tip), 2 and 4 bias-out"));
      keys.push_back(number("bias[].amount_um", 0, most, "required", "removed in the corner [um]"));
      start("bias[].", "at the face end where it starts");
      keys.push_back(number("bias[].length_mm", 0, 1e4, "required", "along the tip or root edge, from the face end [mm]", true));
      shape("bias[].");
      keys.push_back(text("topography.file", "none",
                          "CSV table of what is removed over roll angle and face position; path from the case file's folder"));
      keys.push_back(numbers("index_errors_um", -most, most, "none",
                             "how far each tooth stands back, normal to the flank, in the order of meshing; as many as teeth [um]"));
      keys.push_back(number("runout.amount_um", 0, most, "0", "F_r: twice the eccentricity [um]"));
      keys.push_back(number("runout.angle_deg", -360, 360, "0", "rotation since phase 0 at which the flanks stand back most [deg]"));
      return keys;
    }

    std::vector<Key> parallel_axis_keys()
    {
      std::vector<Key> keys = {
        text("accuracy", "standard", "element mesh, contact grid and near-field quadratures: what their own keys do not set",
             { "draft", "standard", "reference" }),
        number("pair.centre_distance_mm", 0, 1e5, "required", "centre distance [mm]", true),
        number("pair.transverse_module_mm", 0, 1e3, "or normal_module_mm", "transverse module [mm]", true),
        number("pair.normal_module_mm", 0, 1e3, "or transverse_module_mm", "normal module [mm]", true),
        number("pair.transverse_pressure_angle_deg", 5, 45, "or normal_pressure_angle_deg",
               "transverse pressure angle at the reference circle [deg]"),
        number("pair.normal_pressure_angle_deg", 5, 45, "or transverse_pressure_angle_deg",
               "normal pressure angle at the reference cylinder [deg]"),
        number("pair.helix_angle_deg", 0, 45, "0", "helix angle at the reference cylinder [deg]; 0: spur"),
        text("pair.pinion_hand", "right", "hand of the pinion's helix", { "right", "left" }),
        number("pair.centre_distance_error_um", -1e4, 1e4, "0", "added to the centre distance [um]"),
        number("pair.axial_offset_mm", -1e4, 1e4, "0", "z of the gear's mid-face; the pinion's is 0 [mm]"),
        number("misalignment.in_plane_um", -1e4, 1e4, "0",
               "tilt of the axes in the plane of action, over the common face width; > 0: the gap opens towards +z [um]"),
        number("misalignment.in_plane_mrad", -100, 100, "or in_plane_um", "the same as an angle [mrad]"),
        number("misalignment.across_plane_um", -1e4, 1e4, "0",
               "tilt at right angles to the plane of action, over the common face width; > 0: towards the mate at +z [um]"),
        number("misalignment.across_plane_mrad", -100, 100, "or across_plane_um", "the same as an angle [mrad]"),
      };
      for (const std::string gear : { "pinion", "gear" })
        {
          if (gear == "gear")
            keys.push_back(text("gear.like", "", "\"pinion\": every key of [gear] that is left out is copied from [pinion]", { "pinion" }));
          const auto add = [&](Key key) {
            key.path = gear + "." + key.path;
            keys.push_back(std::move(key));
          };
          add(integer("teeth", 6, 1000, "required", "number of teeth"));
          add(number("face_width_mm", 0, 1e4, "required", "face width, centred on z = 0 [mm]", true));
          add(number("tip_diameter_mm", 0, 1e5, "d + 2 m_n (1 + x)", "tip diameter [mm]", true));
          add(number("root_diameter_mm", 0, 1e5, "d - 2 m_n (1.25 - x)", "root diameter [mm]", true));
          add(number("tooth_thickness_mm", 0, 1e4, "from profile_shift", "transverse tooth thickness, arc at the reference circle [mm]",
                     true));
          add(number("profile_shift", -2, 2, "0, or from tooth_thickness_mm", "profile shift coefficient x, of the normal module [-]"));
          add(number("bore_diameter_mm", 0, 1e5, "required", "bore diameter, where the body is clamped [mm]", true));
          add(number("fillet_radius_mm", 0, 1e3, "required", "root fillet radius [mm]", true));
          add(number("youngs_modulus_GPa", 0, 1e4, "required", "Young's modulus [GPa]", true));
          add(number("poissons_ratio", 0, 0.49, "required", "Poisson's ratio [-]"));
          add(number("tip_edge.chamfer_mm", 0, 1e3, "0", "radial height of a chamfer of the tip corner: the flank ends below it [mm]"));
          add(number("tip_edge.rounding_radius_mm", 0, 1e3, "0", "radius of the rounding of the tip corner [mm]"));
          for (const std::string flank : { "", "left_flank.", "right_flank." })
            for (Key key : flank_keys())
              {
                key.path   = gear + "." + flank + key.path;
                key.listed = gear == "pinion" && flank.empty();
                keys.push_back(std::move(key));
              }
        }
      for (const std::string gear : { "pinion", "gear" })
        for (const auto &[key, meaning] : { std::pair{ "torsion", "turning of its hub" },
                                            { "tilt_in_plane", "tilting of its axis in the plane of action, at mid-face" },
                                            { "tilt_across_plane", "tilting of its axis at right angles to that" } })
          keys.push_back(number("mounting." + gear + "_" + key + "_Nm_per_mrad", 0, 1e12, "rigid",
                                std::string("linear spring against ") + meaning + " [N m/mrad]", true));
      for (Key key : {
               text("body.model", "ring", "elastic body, clamped at the bore: the whole gear, or some teeth around the loaded one",
                    { "ring", "segment" }),
               integer("body.segment_teeth", 1, 999, "7", "teeth of a segment, odd; the loaded one is in the middle"),
               text("body.cut_faces", "free", "the two cut faces of a segment", { "free", "clamped" }),
               text("body.reduction", "automatic",
                    "how the body is reduced to its flank: one tooth sector condensed by one process or by all ranks (automatic: by size), "
                    "or all teeth at once (a check)",
                    { "automatic", "condensed", "distributed", "direct" }),
               numbers("load.pinion_torque_Nm", 0, 1e9, "required", "pinion torques [N m]; 0: unloaded"),
               text("load.drive_flank", "counter_clockwise", "sense in which the pinion turns and drives, seen from +z",
                    { "counter_clockwise", "clockwise" }),
               integer("mesh_cycle.positions", 2, 4096, "16", "mesh positions over one cycle"),
               text("mesh_cycle.period", "mesh", "how long: one mesh cycle, or until the same teeth meet again", { "mesh", "hunting" }),
               text("output.light_load_pattern", "no", "yes: the contact pattern at 1 % of every torque too", { "no", "yes" }),
               text("output.root_stress", "no",
                    "yes: greatest tensile stress in both fillets of every loaded tooth, along the face, over the first mesh cycle",
                    { "no", "yes" }),
               text("output.subsurface_stress", "no",
                    "yes: greatest shear and von Mises stress below the greatest pressure inside the flanks, and their depths",
                    { "no", "yes" }),
               text("output.error_estimate", "no",
                    "yes: the case is computed one accuracy level coarser too (draft: finer), and by how much the results differ is told",
                    { "no", "yes" }),
               text("output.derivatives", "no",
                    "yes: a study also gives exact derivatives by every parameter of the loaded flanks' modifications", { "no", "yes" }),
               texts("output.fields", "none", "what is written for ParaView: nothing is computed for what is not listed",
                     { "displacement", "stress", "contact" }),
               numbers("output.field_positions", 0, 4095, "0", "mesh positions of the fields, counted from 0, of the first mesh cycle"),
               numbers("output.field_torques_Nm", 0, 1e9, "the greatest", "torques of the fields, of those computed [N m]"),
               integer("output.field_teeth", 1, 999, "5", "teeth of each body in the fields, odd; the middle one meets at the pitch point"),
               integer("mesh.degree", 1, 3, "by accuracy", "polynomial degree of the elements"),
               integer("mesh.flank_rows", 2, 200, "by accuracy", "elements along the involute"),
               integer("mesh.tooth_columns", 2, 100, "by accuracy", "elements across the tooth, even"),
               integer("mesh.face_layers", 1, 500, "by accuracy", "elements along the face width"),
               integer("mesh.fillet_rows", 1, 100, "by accuracy", "elements along the upper half of each root fillet"),
               integer("mesh.fillet_columns", 1, 100, "by accuracy", "elements along the lower half of each root fillet"),
               integer("mesh.rim_layers", 1, 200, "by accuracy", "elements from root to bore"),
               integer("contact_grid.slices", 1, 1001, "by accuracy: 31, 41, 61", "slices across the common face width (2N+1)"),
               integer("contact_grid.profile_cells", 5, 101, "by accuracy: 11, 11, 15", "cells across the profile in a slice (2M+1)"),
               text("contact.split", "projected", "how near and far field are joined", { "projected", "classical" }),
               integer("contact.near_field_points", 4, 8, "by accuracy: 4, 5, 6",
                       "points of the near field's quadratures in each direction (projected split)"),
               text("contact.classical_depth", "half_element", "matching depth of the classical split", { "half_element", "line_fit" }),
           })
        keys.push_back(std::move(key));
      return keys;
    }

    std::vector<Key> double_roller_keys()
    {
      const double um = 1000; // no part of this size is a tenth of a millimetre off, let alone ten
      return {
        integer("drive.rollers", 3, 1000, "required", "number of fixed rollers N_r; N_r - 1 sleeves"),
        number("drive.roller_circle_radius_mm", 0, 1e4, "required", "radius R of the circle of the rollers' centres [mm]", true),
        number("drive.roller_radius_mm", 0, 1e4, "required", "radius R_r of the rollers [mm]", true),
        number("drive.sleeve_circle_radius_mm", 0, 1e4, "required", "radius R1 of the circle of the sleeves' centres on the carrier [mm]",
               true),
        number("drive.sleeve_radius_mm", 0, 1e4, "required", "outer radius R_s of the sleeves [mm]", true),
        number("drive.eccentricity_mm", 0, 1e3, "required", "eccentricity E of the crank [mm]", true),
        number("drive.width_mm", 0, 1e4, "required", "length of the contact of roller and sleeve [mm]", true),
        number("drive.youngs_modulus_GPa", 0, 1e4, "required", "Young's modulus of rollers and sleeves [GPa]", true),
        number("drive.poissons_ratio", 0, 0.49, "required", "Poisson's ratio of rollers and sleeves [-]"),
        number("drive.sleeve_youngs_modulus_GPa", 0, 1e4, "as the rollers", "Young's modulus of the sleeves alone [GPa]", true),
        number("drive.sleeve_poissons_ratio", 0, 0.49, "as the rollers", "Poisson's ratio of the sleeves alone [-]"),
        text("drive.profile", "circular", "flank of the sleeves: circles, or the exactly conjugate profile", { "circular", "conjugate" }),
        text("drive.crown.type", "straight", "lengthwise form of the rollers", { "straight", "full", "partial" }),
        number("drive.crown.radius_mm", 0, 1e7, "required with full or partial", "radius of the crown [mm]", true),
        number("drive.crown.straight_length_mm", 0, 1e4, "required with partial", "length of the straight part in the middle [mm]", true),
        number("drive.uniform_clearance_um", 0, um, "0", "taken off the surface of every sleeve [um]"),
        numbers("drive.roller_radius_errors_um", -um, um, "none", "added to the radius of each roller, N_r numbers [um]"),
        numbers("drive.sleeve_radius_errors_um", -um, um, "none", "added to the radius of each sleeve, N_r - 1 numbers [um]"),
        numbers("drive.roller_radial_errors_um", -um, um, "none", "position of each roller, outwards, N_r numbers [um]"),
        numbers("drive.roller_tangential_errors_um", -um, um, "none", "position of each roller, counter-clockwise, N_r numbers [um]"),
        numbers("drive.sleeve_radial_errors_um", -um, um, "none", "position of each sleeve on the carrier, outwards, N_r - 1 numbers [um]"),
        numbers("drive.sleeve_tangential_errors_um", -um, um, "none",
                "position of each sleeve on the carrier, counter-clockwise, N_r - 1 numbers [um]"),
        text("model.preset", "exact", "exact: the geometry as it is; paper: every choice below as the paper makes it",
             { "exact", "paper" }),
        text("model.backlash", "exact",
             "exact: gaps on both flanks; drive_only: the coast flank carries nothing; zero: all drive pairs touch unloaded",
             { "exact", "drive_only", "zero" }),
        text("model.candidates", "all", "all: every pair; window: sleeves within (-g/2, pi) of the crank, each with its nearest roller",
             { "all", "window" }),
        text("model.drop_interfering", "no", "yes: a pair that overlaps at the nominal rotation carries nothing", { "no", "yes" }),
        text("model.geometry", "iterate", "iterate: gaps exact at the contact position; linear: about psi = phi/N_s",
             { "iterate", "linear" }),
        text("model.gear_ratio", "instantaneous", "of te.csv: by implicit differentiation, or by secant over one degree of the crank",
             { "instantaneous", "secant" }),
        text("model.torque_on", "output", "what load.output_torque_Nm acts on: the carrier, or (input) the crank", { "output", "input" }),
        numbers("load.output_torque_Nm", 0, 1e9, "required", "torques on the carrier [N m]; 0: unloaded"),
        number("mesh_cycle.crank_angles_deg.from", -3600, 3600, "0", "first crank angle [deg]"),
        number("mesh_cycle.crank_angles_deg.to", -3600, 36000, "from + 360/N_r", "last crank angle [deg]"),
        number("mesh_cycle.crank_angles_deg.step", 0, 360, "1", "step of the crank angle [deg]", true),
        integer("contact_grid.cells_across", 8, 200, "20", "cells over the contact width of one pair, even"),
        integer("contact_grid.cells_along", 4, 400, "40; paper: 60", "cells over the length of one pair, even"),
        text("contact_grid.extent", "automatic",
             "along the roller: automatic follows the contact and is finer near ends; uniform: equal cells, displacement at their centres",
             { "automatic", "uniform" }),
        number("contact_grid.half_width_mm", 0, 1e3, "follows the load",
               "half-width of a prescribed grid across the contact, the same at every load [mm]", true),
        numbers("output.pressure_maps_deg", -3600, 36000, "none", "crank angles whose pressure maps are kept in results.h5 [deg]"),
        text("output.pressure_fields", "no", "yes: these pressure maps also on rollers and sleeves for ParaView", { "no", "yes" }),
      };
    }

    std::vector<Key> make_schema()
    {
      std::vector<Key> keys = {
        text("title", "", "shown in every result"),
        text("scene", "required", "kind of drive", { "parallel_axis", "double_roller" }),
      };
      for (const auto &[scene, own] : { std::pair{ "parallel_axis", parallel_axis_keys() }, { "double_roller", double_roller_keys() } })
        for (Key key : own)
          {
            key.scene = scene;
            keys.push_back(std::move(key));
          }
      return keys;
    }

    std::size_t edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<std::size_t> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0);
      for (std::size_t i = 1; i <= a.size(); ++i)
        {
          std::size_t diagonal = row[0];
          row[0]               = i;
          for (std::size_t j = 1; j <= b.size(); ++j)
            {
              const std::size_t above = row[j];
              row[j]                  = std::min({ row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1]) });
              diagonal                = above;
            }
        }
      return row.back();
    }
  } // namespace

  const std::vector<Key> &schema()
  {
    static const std::vector<Key> keys = make_schema();
    return keys;
  }

  std::string Key::allowed() const
  {
    switch (type)
      {
      case Type::text:
        return choices.empty() ? "a text" : "\"" + fmt::format("{}", fmt::join(choices, "\" or \"")) + "\"";
      case Type::texts:
        return "a list of \"" + fmt::format("{}", fmt::join(choices, "\", \"")) + "\"";
      case Type::integer:
        return fmt::format("an integer from {:g} to {:g}", low, high);
      default:
        return fmt::format("{} {} {:g}{}", type == Type::numbers ? "a list of numbers" : "a number", low_open ? "greater than" : "from",
                           low, high < unbounded ? fmt::format(" {} {:g}", low_open ? "and up to" : "to", high) : "");
      }
  }

  std::string schema_path(const std::string &path)
  {
    std::string result;
    for (std::size_t at = 0; at < path.size();)
      {
        const auto open = path.find('[', at), close = path.find(']', std::min(open, path.size()));
        if (close == std::string::npos)
          return result + path.substr(at);
        const std::string number  = path.substr(open + 1, close - open - 1);
        const bool        numbers = !number.empty() && number.size() <= 2 && number.front() != '0' &&
                             std::all_of(number.begin(), number.end(), [](const char c) { return c >= '0' && c <= '9'; });
        result += path.substr(at, open - at) + (numbers ? "[]" : path.substr(open, close + 1 - open));
        at = close + 1;
      }
    return result;
  }

  const Key *find_key(const std::string &path)
  {
    static const std::map<std::string, const Key *> by_path = [] {
      std::map<std::string, const Key *> result;
      for (const Key &key : schema())
        result[key.path] = &key;
      return result;
    }();
    const auto it = by_path.find(path.find('[') == std::string::npos ? path : schema_path(path));
    return it == by_path.end() ? nullptr : it->second;
  }

  std::string schema_text(const bool markdown)
  {
    const char *twins =
        "Every key of [pinion] that describes its flanks (from tip_relief to runout) exists under [gear], and for one flank alone under "
        "left_flank and right_flank, where it replaces that of both flanks; bias[]: a list of tables.\n";
    std::string result =
        markdown ? std::string(twins) + "\n| key | scene | allowed | when left out | meaning |\n|---|---|---|---|---|\n" : "";
    result += markdown ? "" : twins;
    for (const Key &key : schema())
      if (key.listed)
        result += markdown ? fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path, key.scene.empty() ? "both" : key.scene, key.allowed(),
                                         key.fallback, key.meaning)
                           : fmt::format("{}\n    {}{}\n    allowed: {}\n    when left out: {}\n", key.path,
                                         key.scene.empty() ? "" : "[" + key.scene + "] ", key.meaning, key.allowed(),
                                         key.fallback.empty() ? "empty" : key.fallback);
    return result;
  }

  std::string nearest_key(const std::string &path, const std::string &scene)
  {
    // An index that is none is not far from one.
    const std::string bare = path.substr(0, path.find('[')) +
                             (path.find('[') == std::string::npos ? "" : "[]" + path.substr(std::min(path.size(), path.find(']') + 1)));
    const auto distance = [&](const Key &key) {
      return scene.empty() || key.scene.empty() || key.scene == scene ? edit_distance(key.path, bare) : std::string::npos;
    };
    const Key  *nearest = nullptr;
    std::size_t least   = std::string::npos;
    for (const Key &key : schema())
      if (const std::size_t own = distance(key); !nearest || own < least)
        nearest = &key, least = own;
    return nearest->path;
  }
} // namespace flank
