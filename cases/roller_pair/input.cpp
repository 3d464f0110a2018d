// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/input.hpp"

#include "contact/rollers/roller_ends.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace flank
{
  namespace
  {
    CrownedRoller read_roller(const CaseFile &file, const std::string &name)
    {
      CrownedRoller roller;
      roller.radius = file.number(name + ".radius_mm");
      roller.length = file.number(name + ".length_mm");
      roller.crown_radius = file.optional_number(name + ".crown_radius_mm").value_or(0);
      roller.straight_length = file.number(name + ".straight_length_mm");
      roller.youngs_modulus = file.number(name + ".youngs_modulus_GPa") * units::gigapascal;
      roller.poissons_ratio = file.number(name + ".poissons_ratio");
      const std::string straight = name + ".straight_length_mm";
      if (roller.straight_length > 0 && roller.crown_radius == 0)
        throw InputError(file.place(straight) +
                         "has no effect without crown_radius_mm: the whole roller is straight");
      if (roller.straight_length >= roller.length)
        throw InputError(file.place(straight) +
                         fmt::format("must be less than the length, {:g} mm: nothing is left for the crown",
                                     roller.length));
      if (roller.crown_radius > 0 && roller.crown_radius < roller.length / 2)
        throw InputError(
            file.place(name + ".crown_radius_mm") +
            fmt::format("must be at least half of the length, {:g} mm: the crown ends before the roller does",
                        roller.length / 2));
      return roller;
    }

    int even(const CaseFile &file, const std::string &key)
    {
      const int count = file.integer(key);
      if (count % 2 != 0)
        throw InputError(file.place(key) + "must be even: the middle of the contact lies between two cells");
      return count;
    }
  } // namespace

  RollerPairCase read_roller_pair(const CaseFile &file)
  {
    RollerPairCase input;
    input.title = file.text("title");
    input.rollers.first = read_roller(file, "first_roller");
    input.rollers.second = read_roller(file, "second_roller");
    input.rollers.crossing_angle = file.number("axes.crossing_angle_deg") * units::degree;
    if (file.text("rollers.ends") == "free")
      {
        if (std::abs(std::sin(input.rollers.crossing_angle)) > 1e-12)
          throw InputError(file.place("rollers.ends") +
                           "free needs parallel axes: crossing rollers' ends are no straight edges along the "
                           "contact; leave axes.crossing_angle_deg out, or say half_space");
        if (std::abs(std::sin(input.rollers.curvatures().direction)) > 1e-12)
          throw InputError(
              file.place("rollers.ends") +
              "free needs a contact that is longer along the axes: these crowns are rounder than the "
              "rollers, and the contact does not come near the ends; say half_space");
        input.rollers.free_ends =
            std::make_shared<const RollerEnds>(input.rollers.first, input.rollers.second);
      }
    input.grid = { even(file, "roller_grid.cells_across"), even(file, "roller_grid.cells_along") };
    input.forces = file.numbers_or_zero("load.normal_force_N", 1e-9);
    file.require_all_used();
    return input;
  }

  std::string roller_pair_report(const RollerPairCase &input)
  {
    const RollerPairData::Curvatures curvature = input.rollers.curvatures();
    std::string result = fmt::format("{}\nTwo rollers: effective modulus {:.1f} MPa; principal relative "
                                     "curvatures {:.6g} and {:.6g} 1/mm, the least one {:.4f} deg from "
                                     "the first axis\n",
                                     input.title, input.rollers.effective_modulus(), curvature.least,
                                     curvature.greatest, curvature.direction / units::degree);
    for (const double force : input.forces)
      {
        const HertzReference reference = hertz(input.rollers, force);
        result += fmt::format("{:>12.6g} N: ", force);
        if (const auto &e = reference.ellipse)
          result += fmt::format("Hertz, ellipse {:.5g} x {:.5g} mm, pressure {:.5g} MPa, approach {:.5g} um, "
                                "stiffness {:.5g} N/um\n",
                                2 * e->long_half_axis, 2 * e->short_half_axis, e->max_pressure,
                                e->approach / units::micrometre, e->stiffness / units::newton_per_micrometre);
        else if (const auto &l = reference.line)
          result += fmt::format("Hertz, line {:.5g} mm wide, pressure {:.5g} MPa; it has no approach\n",
                                2 * l->half_width, l->max_pressure);
        else
          result += force == 0 ? "unloaded\n" : "no closed form: " + reference.missing + "\n";
      }
    return result;
  }
} // namespace flank
