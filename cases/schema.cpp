// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flank
{
  namespace
  {
    constexpr double unbounded = 1e300;

    Key text(std::string path, std::string fallback, std::string meaning, std::vector<std::string> choices = {})
    {
      return { std::move(path), Key::Type::text, 0, 0, false, std::move(fallback), std::move(meaning), std::move(choices) };
    }
    Key number(std::string path, double low, double high, std::string fallback, std::string meaning, bool low_open = false)
    {
      return { std::move(path), Key::Type::number, low, high, low_open, std::move(fallback), std::move(meaning), {} };
    }
    Key integer(std::string path, double low, double high, std::string fallback, std::string meaning)
    {
      return { std::move(path), Key::Type::integer, low, high, false, std::move(fallback), std::move(meaning), {} };
    }

    std::vector<Key> make_schema()
    {
      std::vector<Key> keys = {
        text("title", "", "shown in every result"),
        text("scene", "required", "kind of drive", { "parallel_axis" }),
        text("accuracy", "standard", "element mesh: what [mesh] does not set", { "draft", "standard", "reference" }),
        number("pair.centre_distance_mm", 0, 1e5, "required", "centre distance [mm]", true),
        number("pair.transverse_module_mm", 0, 1e3, "or normal_module_mm", "transverse module [mm]", true),
        number("pair.normal_module_mm", 0, 1e3, "or transverse_module_mm", "normal module [mm]", true),
        number("pair.transverse_pressure_angle_deg", 5, 45, "or normal_pressure_angle_deg",
               "transverse pressure angle at the reference circle [deg]"),
        number("pair.normal_pressure_angle_deg", 5, 45, "or transverse_pressure_angle_deg",
               "normal pressure angle at the reference cylinder [deg]"),
        number("pair.helix_angle_deg", 0, 45, "0", "helix angle at the reference cylinder [deg]; 0: spur"),
        text("pair.pinion_hand", "right", "hand of the pinion's helix", { "right", "left" }),
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
          add(number("tip_relief.amount_um", 0, 1e4, "0", "material removed at the tip circle, normal to the flank [um]"));
          add(number("tip_relief.start_roll_angle_deg", 0, 90, "required with the amount", "roll angle where tip relief starts [deg]"));
          add(text("tip_relief.shape", "linear", "profile of the relief over the roll angle", { "linear", "quadratic" }));
          add(number("root_relief.amount_um", 0, 1e4, "0", "material removed at the start of active profile, normal to the flank [um]"));
          add(number("root_relief.start_roll_angle_deg", 0, 90, "required with the amount",
                     "roll angle where root relief starts, going down [deg]"));
          add(text("root_relief.shape", "linear", "profile of the relief over the roll angle", { "linear", "quadratic" }));
          add(number("lead_crown.amount_um", 0, 1e4, "0", "lead crown h (2 z/b)^2: material removed at the face ends [um]"));
        }
      for (Key key : {
               text("body.model", "ring", "elastic body: the whole gear, clamped at the bore", { "ring" }),
               Key{ "load.pinion_torque_Nm", Key::Type::numbers, 0, 1e9, false, "required", "pinion torques [N m]; 0: unloaded", {} },
               text("load.drive_flank", "counter_clockwise", "sense in which the pinion turns and drives, seen from +z",
                    { "counter_clockwise", "clockwise" }),
               integer("mesh_cycle.positions", 2, 4096, "16", "mesh positions over one cycle"),
               integer("mesh.degree", 1, 3, "by accuracy", "polynomial degree of the elements"),
               integer("mesh.flank_rows", 2, 200, "by accuracy", "elements along the involute"),
               integer("mesh.tooth_columns", 2, 100, "by accuracy", "elements across the tooth, even"),
               integer("mesh.face_layers", 1, 500, "by accuracy", "elements along the face width"),
               integer("mesh.rim_layers", 1, 200, "by accuracy", "elements from root to bore"),
               integer("contact_grid.slices", 1, 1001, "41", "slices across the common face width (2N+1)"),
               integer("contact_grid.profile_cells", 5, 101, "11", "cells across the profile in a slice (2M+1)"),
               text("contact.split", "projected", "how near and far field are joined", { "projected", "classical" }),
               text("contact.classical_depth", "half_element", "matching depth of the classical split", { "half_element", "line_fit" }),
           })
        keys.push_back(std::move(key));
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
      case Type::integer:
        return fmt::format("an integer from {:g} to {:g}", low, high);
      default:
        return fmt::format("{} {} {:g}{}", type == Type::numbers ? "a list of numbers" : "a number", low_open ? "greater than" : "from",
                           low, high < unbounded ? fmt::format(" {} {:g}", low_open ? "and up to" : "to", high) : "");
      }
  }

  std::string schema_text(const bool markdown)
  {
    std::string result = markdown ? "| key | allowed | when left out | meaning |\n|---|---|---|---|\n" : "";
    for (const Key &key : schema())
      result += markdown ? fmt::format("| `{}` | {} | {} | {} |\n", key.path, key.allowed(), key.fallback, key.meaning)
                         : fmt::format("{}\n    {}\n    allowed: {}\n    when left out: {}\n", key.path, key.meaning, key.allowed(),
                                       key.fallback.empty() ? "empty" : key.fallback);
    return result;
  }

  std::string nearest_key(const std::string &path)
  {
    return std::min_element(schema().begin(), schema().end(),
                            [&](const Key &a, const Key &b) { return edit_distance(a.path, path) < edit_distance(b.path, path); })
        ->path;
  }
} // namespace flank
