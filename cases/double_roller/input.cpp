// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/input.hpp"

#include "cases/double_roller/drive_measures.hpp"
#include "cases/double_roller/supports.hpp"
#include "cases/double_roller/tolerances.hpp"

#include "contact/rollers/roller_ends.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace flank
{
  namespace
  {
    std::vector<double> lengths(const CaseFile &file, const std::string &key)
    {
      std::vector<double> values;
      if (file.has(key))
        for (const double value : file.numbers(key))
          values.push_back(value * units::micrometre);
      return values;
    }

    /// Position errors along and across the radius of each part, turned into the drive's frame.
    std::vector<Eigen::Vector2d> position_errors(const CaseFile &file, const std::string &part,
                                                 const int count, const double first_angle)
    {
      const std::string radial_key = "drive." + part + "_radial_errors_um",
                        tangential_key = "drive." + part + "_tangential_errors_um";
      const std::vector<double> radial = lengths(file, radial_key),
                                tangential = lengths(file, tangential_key);
      for (const auto &[key, values] : { std::pair{ radial_key, radial }, { tangential_key, tangential } })
        if (!values.empty() && static_cast<int>(values.size()) != count)
          throw InputError(file.place(key) + fmt::format("{}, needed are {}: one for each {}",
                                                         counted(values.size(), "number"), count, part));
      if (radial.empty() && tangential.empty())
        return {};
      std::vector<Eigen::Vector2d> errors;
      for (int k = 0; k < count; ++k)
        errors.push_back(
            Eigen::Rotation2Dd(2 * units::pi / count * k + first_angle) *
            Eigen::Vector2d(radial.empty() ? 0 : radial[k], tangential.empty() ? 0 : tangential[k]));
      return errors;
    }

    double of_drive(const CaseFile &file, const std::string &key)
    {
      return file.number("drive." + key);
    }

    DoubleRollerData read_drive(const CaseFile &file)
    {
      DoubleRollerData drive;
      drive.rollers = file.integer("drive.rollers");
      drive.roller_circle_radius = of_drive(file, "roller_circle_radius_mm");
      drive.roller_radius = of_drive(file, "roller_radius_mm");
      drive.sleeve_circle_radius = of_drive(file, "sleeve_circle_radius_mm");
      drive.sleeve_radius = of_drive(file, "sleeve_radius_mm");
      drive.eccentricity = of_drive(file, "eccentricity_mm");
      drive.clearance = of_drive(file, "uniform_clearance_um") * units::micrometre;
      if (drive.clearance >= drive.sleeve_radius)
        throw InputError(
            file.place("drive.uniform_clearance_um") +
            fmt::format("must be less than the sleeves' radius ({:.6g} um), off which it is taken",
                        drive.sleeve_radius / units::micrometre));
      drive.roller_radius_error = lengths(file, "drive.roller_radius_errors_um");
      drive.sleeve_radius_error = lengths(file, "drive.sleeve_radius_errors_um");
      const int n_r = drive.rollers;
      drive.roller_position_error = position_errors(file, "roller", n_r, 2 * units::pi / n_r);
      drive.sleeve_position_error = position_errors(file, "sleeve", n_r - 1, units::pi / (n_r - 1));
      draw_errors(file, drive);
      return drive;
    }

    /// A choice of the model: what the case says, else what its preset does.
    std::string choice(const CaseFile &file, const std::string &key, const std::string &of_paper)
    {
      return file.has(key) || file.text("model.preset") != "paper" ? file.text(key) : of_paper;
    }

    DoubleRollerModel read_model(const CaseFile &file, const DoubleRollerData &drive)
    {
      DoubleRollerModel model;
      const std::string backlash = choice(file, "model.backlash", "zero");
      model.backlash = backlash == "exact"  ? Backlash::exact
                       : backlash == "zero" ? Backlash::zero
                                            : Backlash::drive_only;
      model.window = choice(file, "model.candidates", "window") == "window";
      model.drop_interfering = choice(file, "model.drop_interfering", "yes") == "yes";
      model.linear = choice(file, "model.geometry", "linear") == "linear";
      model.secant_ratio = choice(file, "model.gear_ratio", "secant") == "secant";
      model.input_torque = choice(file, "model.torque_on", "output") == "input";
      model.conjugate = choice(file, "drive.profile", "circular") == "conjugate";
      if (model.conjugate && (!drive.roller_radius_error.empty() || !drive.sleeve_radius_error.empty() ||
                              !drive.roller_position_error.empty() || !drive.sleeve_position_error.empty()))
        throw InputError(file.place("drive.profile") +
                         "errors of single parts are for circular sleeves only");
      // A case that says so itself; of a preset they are what it is for circles.
      for (const auto &[key, approximates] : { std::pair{ "model.geometry", model.linear },
                                               { "model.candidates", model.window },
                                               { "model.drop_interfering", model.drop_interfering } })
        if (model.conjugate && approximates && file.has(key))
          throw InputError(file.place(key) +
                           "has no effect on the exactly conjugate profile, whose pairs all "
                           "touch at the nominal rotation; remove it");
      return model;
    }

    void read_crown(const CaseFile &file, RollerContactData &contact)
    {
      const std::string crown = file.text("drive.crown.type"), radius = "drive.crown.radius_mm",
                        straight = "drive.crown.straight_length_mm";
      if (crown == "straight")
        {
          for (const std::string &key : { radius, straight })
            if (file.has(key))
              throw InputError(file.place(key) +
                               "contradicts drive.crown.type = straight; give type = full or partial");
          return;
        }
      if (!file.has(radius))
        throw InputError(file.place("drive.crown.type") + "needs " + radius);
      contact.crown_radius = file.number(radius);
      if (crown == "partial")
        {
          if (!file.has(straight))
            throw InputError(file.place("drive.crown.type") + "needs " + straight);
          contact.straight_length = file.number(straight);
          if (contact.straight_length >= contact.width)
            throw InputError(file.place(straight) +
                             fmt::format("must be shorter than the roller ({:.6g} mm)", contact.width));
        }
      if (contact.crown_radius <= contact.width / 2)
        throw InputError(file.place(radius) +
                         fmt::format("must be greater than half the width ({:.6g} mm)", contact.width / 2));
    }

    RollerContactData read_contact(const CaseFile &file, const DoubleRollerData &drive)
    {
      RollerContactData contact;
      contact.roller_radius = drive.roller_radius;
      contact.sleeve_radius = drive.sleeve_radius - drive.clearance; // errors of single ones are micrometres
      contact.width = of_drive(file, "width_mm");
      const double modulus = of_drive(file, "youngs_modulus_GPa"), poisson = of_drive(file, "poissons_ratio");
      contact.roller_modulus = modulus * units::gigapascal;
      contact.roller_poisson = poisson;
      contact.sleeve_modulus =
          file.optional_number("drive.sleeve_youngs_modulus_GPa").value_or(modulus) * units::gigapascal;
      contact.sleeve_poisson = file.optional_number("drive.sleeve_poissons_ratio").value_or(poisson);
      read_crown(file, contact);
      return contact;
    }

    /// Rollers and sleeves of the contact's width, whose ends are free, where a case says so.
    void read_ends(const CaseFile &file, const RollerGridSize &grid, RollerContactData &contact)
    {
      const std::string key = "model.roller_ends";
      if (file.text(key) == "half_space")
        return;
      if (grid.uniform)
        throw InputError(file.place(key) +
                         "free needs means over cells that follow the contact: give contact_grid.extent = "
                         "automatic");
      contact.free_ends =
          std::make_shared<const RollerEnds>(CrownedRoller{ .length = contact.width,
                                                            .youngs_modulus = contact.roller_modulus,
                                                            .poissons_ratio = contact.roller_poisson },
                                             CrownedRoller{ .length = contact.width,
                                                            .youngs_modulus = contact.sleeve_modulus,
                                                            .poissons_ratio = contact.sleeve_poisson });
    }

    RollerGridSize read_grid(const CaseFile &file, const DoubleRollerData &drive)
    {
      RollerGridSize grid;
      grid.uniform = choice(file, "contact_grid.extent", "uniform") == "uniform";
      grid.half_width = file.optional_number("contact_grid.half_width_mm").value_or(0);
      const double half_radius = 0.5 * std::min(drive.roller_radius, drive.sleeve_radius);
      if (grid.half_width >= half_radius)
        throw InputError(file.place("contact_grid.half_width_mm") +
                         fmt::format("must be below half the smaller radius ({:.6g} mm)", half_radius));
      if (grid.half_width > 0 && grid.half_width < 1e-5 * half_radius)
        throw InputError(file.place("contact_grid.half_width_mm") +
                         fmt::format("is less than a hundred-thousandth of half the smaller radius ({:.6g} "
                                     "mm): no contact that carries anything is so narrow",
                                     half_radius));
      grid.across = file.integer("contact_grid.cells_across");
      grid.along = file.has("contact_grid.cells_along")   ? file.integer("contact_grid.cells_along")
                   : file.text("model.preset") == "paper" ? 60
                                                          : 40;
      for (const auto &[key, value] : { std::pair{ "contact_grid.cells_across", grid.across },
                                        { "contact_grid.cells_along", grid.along } })
        if (value % 2)
          throw InputError(file.place(key) + "must be even: a quarter of the contact is computed");
      return grid;
    }

    /// The step where a case gives none [deg]: 1, and over one pitch of the rollers that in equal parts of at
    /// most 1, so many that they show a wave.
    double usual_step(const bool has_end, const double pitch)
    {
      constexpr double least_parts = 4;
      return has_end ? 1 : pitch / std::max(least_parts, std::ceil(pitch - 1e-9));
    }

    /// [rad], from the first crank angle to the last one by steps; over one pitch of the rollers where no
    /// last one is given.
    std::vector<double> read_crank_angles(const CaseFile &file, const int rollers)
    {
      const std::string key = "mesh_cycle.crank_angles_deg.";
      const bool has_end = file.has(key + "to");
      const double pitch = 360.0 / rollers, from = file.number(key + "from"),
                   to = has_end ? file.number(key + "to") : from + pitch,
                   step = file.optional_number(key + "step").value_or(usual_step(has_end, pitch));
      if (to < from)
        throw InputError(file.place(key + "to") + fmt::format("must not be less than from ({:.6g})", from));
      const double steps = (to - from) / step, count = std::round(steps) + 1;
      if (count > 100000)
        throw InputError(file.place(key + "step") +
                         fmt::format("gives {:.0f} positions, at most 100000 are allowed", count));
      if (std::abs(steps - std::round(steps)) > 1e-6)
        {
          const double before = from + std::floor(steps) * step;
          const std::string nearest = fmt::format("{:.9g} or {:.9g}", before, before + step);
          throw InputError(
              has_end
                  ? file.place(key + "to") +
                        fmt::format("must be whole steps of {:.9g} from {:.9g}; give {}", step, from, nearest)
                  : file.place(key + "step") +
                        fmt::format("does not divide 360/N_r = {:.9g}, over which the crank turns where to "
                                    "is left out; give one that does, or to = {}",
                                    pitch, nearest));
        }
      std::vector<double> angles;
      for (int i = 0; i < static_cast<int>(count); ++i)
        angles.push_back((from + i * step) * units::degree);
      return angles;
    }

    /// Said once, before anything is computed: where circular rollers and sleeves overlap unloaded.
    void warn_of_overlap(const DoubleRollerDrive &drive, DoubleRollerCase &c)
    {
      const DoubleRollerDrive::LeastGap least = drive.least_gap();
      constexpr double rounding = 1e-9; // of coordinates of the drive [mm]
      if (!c.model.conjugate && least.interference > rounding)
        c.warnings.push_back(fmt::format(
            "rollers and sleeves overlap: least gap {:.3f} um on the drive flank, {:.3f} um on the coast "
            "flank over the cycle; the unloaded drive is preloaded. "
            "A uniform clearance of {:.3f} um would free it",
            least.drive / units::micrometre, least.coast / units::micrometre,
            least.interference / units::micrometre));
    }

    /// Said where errors of single parts do not come round over the crank angles.
    void warn_of_part_of_period(const DoubleRollerDrive &drive, DoubleRollerCase &c)
    {
      if (pitches_in_period(c.drive) == 1 || period_positions(c) > 0)
        return;
      const double period = drive.period() / units::degree,
                   to = c.crank_angles.front() / units::degree + period;
      std::string warning = fmt::format(
          "errors of single parts repeat after {:.9g} deg of the crank, not after 360/N_r: mean and "
          "peak-to-peak are of the computed angles alone, and there are no harmonics",
          period);
      if (to <= 36000)
        warning += fmt::format("; mesh_cycle.crank_angles_deg.to = {:.9g}, with a step that divides this "
                               "period, computes all of it",
                               to);
      c.warnings.push_back(warning);
    }

    /// Where a case gives the quantities that double_roller.hpp refuses.
    std::map<std::string, std::string> keys_of_quantities()
    {
      return { { "roller radius", "drive.roller_radius_mm" },
               { "sleeve radius", "drive.sleeve_radius_mm" },
               { "eccentricity", "drive.eccentricity_mm" },
               { "roller radius errors", "drive.roller_radius_errors_um" },
               { "sleeve radius errors", "drive.sleeve_radius_errors_um" },
               { "roller position errors", "drive.roller_position_errors_um" },
               { "sleeve position errors", "drive.sleeve_position_errors_um" } };
    }
  } // namespace

  DoubleRollerCase read_double_roller(const CaseFile &file)
  {
    DoubleRollerCase c;
    c.title = file.text("title");
    c.drive = read_drive(file);
    const auto drive = file.with_places(keys_of_quantities(), [&] { return DoubleRollerDrive(c.drive); });
    c.model = read_model(file, c.drive);
    c.contact = read_contact(file, c.drive);
    c.grid = read_grid(file, c.drive);
    read_ends(file, c.grid, c.contact);
    c.supports = read_supports(file, c);
    for (const double torque : file.numbers_or_zero("load.output_torque_Nm", 1e-12))
      c.torques.push_back(torque * units::newton_metre);
    c.crank_angles = read_crank_angles(file, c.drive.rollers);
    c.pressure_maps = PressureMaps(file, c.crank_angles);
    warn_of_overlap(drive, c);
    warn_of_part_of_period(drive, c);
    file.require_all_used();
    return c;
  }

  std::string drive_report(const DoubleRollerCase &input)
  {
    const DoubleRollerDrive drive(input.drive);
    const auto least = drive.least_gap();
    std::string r = "Double-roller drive\n";
    const auto line = [&](const char *name, const double value, const char *unit) {
      r += fmt::format("  {:<52}{:>14.6f} {}\n", name, value, unit);
    };
    r += fmt::format("  {:<52}{:>14}\n  {:<52}{:>14}\n", "rollers, fixed", input.drive.rollers,
                     "sleeves on the carrier", drive.sleeves());
    line("transmission ratio N_s / (N_r - N_s)", drive.sleeves(), "");
    line("period of the crank angle", drive.period() / units::degree, "deg");
    line("roller circle radius", input.drive.roller_circle_radius, "mm");
    line("roller radius", input.drive.roller_radius, "mm");
    line("sleeve circle radius", input.drive.sleeve_circle_radius, "mm");
    line("sleeve radius", input.drive.sleeve_radius, "mm");
    line("eccentricity", input.drive.eccentricity, "mm");
    line("eccentricity times rollers / roller circle radius",
         input.drive.eccentricity * input.drive.rollers / input.drive.roller_circle_radius, "");
    line("least gap over the cycle, drive flank", least.drive / units::micrometre, "um");
    line("least gap over the cycle, coast flank", least.coast / units::micrometre, "um");
    line("uniform clearance that frees it of interference", least.interference / units::micrometre, "um");
    const DoubleRollerDrive::ConjugateExtremes conjugate = drive.conjugate_extremes();
    r += "Exactly conjugate profile (double-roller actuator article, eqs. 3, 4; bibliography in "
         "contact/bibliography.md)\n";
    line("least convex radius of curvature", conjugate.least_convex, "mm");
    if (conjugate.least_hollow)
      line("least hollow radius of curvature", *conjugate.least_hollow, "mm");
    line("departs from the circular sleeve by, least", conjugate.least_departure / units::micrometre, "um");
    line("departs from the circular sleeve by, most", conjugate.most_departure / units::micrometre, "um");
    if (conjugate.least_hollow && *conjugate.least_hollow < input.drive.roller_radius)
      r += "warning: the conjugate profile is undercut: its hollow radius is below the roller's\n";
    for (const std::string &warning : input.warnings)
      r += "warning: " + warning + "\n";
    r += "What this cannot know: loads, pressures, rotation under torque.\n";
    return r;
  }
} // namespace flank
