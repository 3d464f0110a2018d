// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/tolerances.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <cmath>
#include <random>

namespace flank
{
  using namespace keys;

  namespace
  {
    const std::string of = "drive.tolerances.";

    /// Kinds of errors, in the order of their numbers in a seed.
    constexpr const char *kinds[] = { "roller_radius_um", "sleeve_radius_um", "roller_position_um",
                                      "sleeve_position_um" };

    /// Evenly in [-1, 1), the same on every machine.
    double drawn(const int seed, const int kind, const int part, const int axis)
    {
      std::seed_seq sequence{ seed, kind, part, axis };
      return std::ldexp(static_cast<double>(std::mt19937_64(sequence)() >> 11), -52) - 1;
    }

    /// [mm]
    double tolerance(const CaseFile &file, const int kind)
    {
      return file.number(of + kinds[kind]) * units::micrometre;
    }

    void add_radii(const double most, const int seed, const int kind, const int count,
                   std::vector<double> &errors)
    {
      if (most == 0)
        return;
      if (errors.empty()) // a list of another length is refused where the drive is put together
        errors.assign(static_cast<std::size_t>(count), 0.0);
      for (std::size_t k = 0; k < errors.size(); ++k)
        errors[k] += most * drawn(seed, kind, static_cast<int>(k), 0);
    }

    void add_positions(const double most, const int seed, const int kind, const int count,
                       std::vector<Eigen::Vector2d> &errors)
    {
      if (most == 0)
        return;
      if (errors.empty())
        errors.assign(static_cast<std::size_t>(count), Eigen::Vector2d::Zero());
      for (std::size_t k = 0; k < errors.size(); ++k)
        errors[k] += most * Eigen::Vector2d(drawn(seed, kind, static_cast<int>(k), 0),
                                            drawn(seed, kind, static_cast<int>(k), 1));
    }
  } // namespace

  std::vector<Key> tolerance_keys()
  {
    const double um = 1000;
    return {
      integer(of + "seed", 0, 1e9, "required with a tolerance",
              "which of the drives within the tolerances this is"),
      number(of + kinds[0], 0, um, "0", "errors of the rollers' radii, drawn evenly from - to + [um]"),
      number(of + kinds[1], 0, um, "0", "errors of the sleeves' radii, likewise [um]"),
      number(of + kinds[2], 0, um, "0",
             "errors of the rollers' positions, along two fixed axes each, likewise [um]"),
      number(of + kinds[3], 0, um, "0",
             "errors of the sleeves' positions, along two axes of the carrier each, likewise [um]"),
      number("drive.eccentricity_error_um", -um, um, "0", "added to the eccentricity of the crank [um]"),
    };
  }

  void draw_errors(const CaseFile &file, DoubleRollerData &drive)
  {
    drive.eccentricity += file.number("drive.eccentricity_error_um") * units::micrometre;
    if (drive.eccentricity <= 0)
      throw InputError(file.place("drive.eccentricity_error_um") + "takes all of drive.eccentricity_mm");
    bool draws = false;
    for (const char *kind : kinds)
      if (file.number(of + kind) > 0)
        {
          draws = true;
          if (!file.has(of + "seed"))
            throw InputError(file.place(of + kind) + "needs " + of +
                             "seed, a number that says which of the drives within the tolerances this is");
        }
    if (!draws)
      {
        if (file.has(of + "seed"))
          throw InputError(file.place(of + "seed") + "has no effect without a tolerance above 0");
        return;
      }
    const int seed = file.integer(of + "seed");
    add_radii(tolerance(file, 0), seed, 0, drive.rollers, drive.roller_radius_error);
    add_radii(tolerance(file, 1), seed, 1, drive.rollers - 1, drive.sleeve_radius_error);
    add_positions(tolerance(file, 2), seed, 2, drive.rollers, drive.roller_position_error);
    add_positions(tolerance(file, 3), seed, 3, drive.rollers - 1, drive.sleeve_position_error);
  }
} // namespace flank
