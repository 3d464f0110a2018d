// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/keys.hpp"

namespace flank
{
  using namespace keys;

  SceneKeys roller_pair_keys()
  {
    std::vector<Key> all;
    for (const std::string name : { "first_roller", "second_roller" })
      {
        if (name == "second_roller")
          all.push_back(
              text("second_roller.like", "",
                   "\"first_roller\": every key of it that is left out is copied from [first_roller]",
                   { "first_roller" }));
        for (Key key : {
                 number("radius_mm", 1e-3, 1e5, "required", "radius of the cylinder [mm]"),
                 number("length_mm", 1e-3, 1e5, "required", "length of the cylinder [mm]"),
                 number("crown_radius_mm", 1e-3, 1e7, "straight", "radius of its crown along the axis [mm]"),
                 number("straight_length_mm", 0, 1e5, "0",
                        "in the middle of it, before the crown begins [mm]"),
                 number("youngs_modulus_GPa", 1e-3, 1e4, "required", "Young's modulus [GPa]"),
                 number("poissons_ratio", 0, 0.4999, "required", "Poisson's ratio [-]"),
             })
          {
            key.path = name + "." + key.path;
            all.push_back(std::move(key));
          }
      }
    all.push_back(number("axes.crossing_angle_deg", -180, 180, "0",
                         "from the first axis to the second one, counter-clockwise seen from the second "
                         "roller; 0: parallel [deg]"));
    all.push_back(
        text("rollers.ends", "half_space",
             "of rollers with parallel axes: the half-space goes on there, or the ends are free, as edges "
             "of quarter-spaces",
             { "half_space", "free" }));
    all.push_back(numbers("load.normal_force_N", 0, 1e9, "required",
                          "forces that press the rollers together [N]; 0: unloaded"));
    all.push_back(integer("roller_grid.cells_across", 16, 96, "32", "cells across the contact, even"));
    all.push_back(integer("roller_grid.cells_along", 16, 192, "48", "cells along the contact, even"));
    const CopyRule like_first = {
      .key = "second_roller.like",
      .from = "first_roller.",
      .to = "second_roller.",
      .rivals = [](const std::string &path) { return std::vector{ path }; },
    };
    return { .scene = "roller_pair", .keys = std::move(all), .copy = { like_first } };
  }
} // namespace flank
