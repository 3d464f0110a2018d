// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/geometry_report.hpp"

#include "contact/loaded/load_distribution.hpp"
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    /// The sum of both loaded flanks' modifications as a drawing gives it: a few roll angles by a few face
    /// positions. [um]
    std::string modification_table(const ParallelAxisCase &input)
    {
      const FlankMap map = sum_of_modifications(input.pair, input.deviations);
      if (map.value.cwiseAbs().maxCoeff() == 0)
        return "";
      std::string r = "Removed from both loaded flanks together [um], over the pinion's roll angle (down) "
                      "and z (across)\n     deg \\ mm";
      const int columns = static_cast<int>(map.z.size()), rows = static_cast<int>(map.roll.size());
      for (int j = 0; j < columns; j += (columns - 1) / 8)
        r += fmt::format("{:>9.3f}", map.z[j]);
      for (int i = rows - 1; i >= 0; i -= (rows - 1) / 12)
        {
          r += fmt::format("\n  {:>11.4f}", map.roll[i] / units::degree);
          for (int j = 0; j < columns; j += (columns - 1) / 8)
            r += fmt::format("{:>9.3f}", map.value(i, j) / units::micrometre);
        }
      return r + "\n";
    }

    using units::degree;

    std::string line(const char *name, const double value, const char *unit)
    {
      return fmt::format("  {:<44}{:>14.6f} {}\n", name, value, unit);
    }

    std::string pair_lines(const GearPair &p)
    {
      return "Pair\n" + line("centre distance", p.data.centre_distance, "mm") +
             line("normal module", p.normal_module, "mm") +
             line("transverse module", p.data.transverse_module, "mm") +
             line("transverse pressure angle", p.data.transverse_pressure_angle / degree, "deg") +
             line("transverse working pressure angle", p.working_pressure_angle / degree, "deg") +
             line("helix angle", p.data.helix_angle / degree, "deg") +
             line("base helix angle", p.base_helix_angle / degree, "deg") +
             line("transverse base pitch", p.transverse_base_pitch, "mm") +
             line("length of action", p.length_of_action, "mm") +
             line("transverse contact ratio", p.transverse_contact_ratio, "") +
             line("overlap ratio", p.overlap_ratio, "") +
             line("total contact ratio", p.total_contact_ratio(), "") +
             line("backlash at the pitch circles", p.backlash, "mm");
    }

    std::string roll_angle_lines(const Gear &gear, const RollAngles &roll)
    {
      return line("roll angle: form circle", gear.form_roll / degree, "deg") +
             line("roll angle: start of active profile", roll.start_of_active_profile / degree, "deg") +
             line("roll angle: LPSTC", roll.lowest_single_contact / degree, "deg") +
             line("roll angle: pitch point", roll.pitch_point / degree, "deg") +
             line("roll angle: HPSTC", roll.highest_single_contact / degree, "deg") +
             line("roll angle: end of the involute at the tip", roll.tip / degree, "deg");
    }

    std::string gear_lines(const ParallelAxisCase &input, const bool of_pinion)
    {
      const GearPair &p = input.pair;
      const Gear &g = of_pinion ? p.pinion : p.gear;
      const SectorResolution &mesh = of_pinion ? input.pinion_mesh : input.gear_mesh;
      const bool right = (p.data.pinion_hand == Hand::right) == of_pinion;
      const char *hand = p.data.helix_angle == 0 ? "spur" : right ? "right hand" : "left hand";
      std::string r = fmt::format("{} ({} teeth, {})\n", g.name, g.teeth, hand) +
                      line("reference diameter", 2 * g.reference_radius, "mm") +
                      line("base radius", g.base_radius, "mm") +
                      line("tip diameter", 2 * g.tip_radius, "mm") +
                      line("form diameter (end of fillet)", 2 * g.form_radius, "mm") +
                      line("root diameter", 2 * g.root_radius, "mm") +
                      line("bore diameter, clamped", 2 * g.bore_radius, "mm") +
                      line("tooth thickness at the reference circle", g.tooth_thickness, "mm") +
                      line("profile shift coefficient", g.profile_shift, "") +
                      line("tooth thickness at the tip", g.tip_thickness, "mm") +
                      line("tip clearance", of_pinion ? p.pinion_tip_clearance : p.gear_tip_clearance, "mm") +
                      roll_angle_lines(g, of_pinion ? p.pinion_roll : p.gear_roll);
      if (g.tip_chamfer > 0 || g.tip_rounding > 0)
        r += line(g.tip_chamfer > 0 ? "tip chamfer, radial height" : "tip rounding, radius",
                  std::max(g.tip_chamfer, g.tip_rounding), "mm") +
             line("usable tip diameter", 2 * g.usable_tip_radius(), "mm");
      return r +
             fmt::format("  body: {}\n  elements of degree {}: {} along the involute, {} across the tooth, "
                         "{} along the face, {} to the bore\n",
                         input.body.describe(), mesh.degree, mesh.flank_rows, mesh.tooth_columns,
                         mesh.face_layers, mesh.rim_layers);
    }

    std::string flank_lines(const FlankDeviations &flanks, const double base_radius)
    {
      std::string r;
      for (const auto &modification : flanks.modifications)
        r += "    " + modification->describe(base_radius) + "\n";
      if (!flanks.index_errors.empty())
        {
          const auto [least, greatest] =
              std::minmax_element(flanks.index_errors.begin(), flanks.index_errors.end());
          r += fmt::format("    index errors of {} teeth, {:.3f} to {:.3f} um\n", flanks.index_errors.size(),
                           *least / units::micrometre, *greatest / units::micrometre);
        }
      if (flanks.runout > 0)
        r += fmt::format("    runout {:.3f} um, flanks stand back most at {:.3f} deg\n",
                         flanks.runout / units::micrometre, flanks.runout_angle / degree);
      return r.empty() ? "    as the involute\n" : r;
    }

    std::string all_flanks(const ParallelAxisCase &input)
    {
      const GearPair &p = input.pair;
      std::string r = "Flanks (material removed normal to the flank; left and right as seen from +z with the "
                      "tooth pointing up)\n";
      const bool left_loaded = p.data.counter_clockwise_drive;
      for (const bool left : { left_loaded, !left_loaded })
        for (const bool of_pinion : { true, false })
          {
            const MeshDeviations &side = left == left_loaded ? input.deviations : input.coast;
            const Gear &g = of_pinion ? p.pinion : p.gear;
            r += fmt::format("  {}, {} flank ({})\n", g.name, left ? "left" : "right",
                             left == left_loaded ? "loaded" : "not loaded") +
                 flank_lines(of_pinion ? side.pinion : side.gear, g.base_radius);
          }
      return r;
    }

    std::string spring_lines(const Mounting &mounting, const std::string &gear)
    {
      std::string r;
      for (const auto &[name, stiffness] : { std::pair{ ": torsion", mounting.torsion },
                                             { ": tilt in the plane of action", mounting.tilt_in_plane },
                                             { ": tilt across the plane of action", mounting.tilt_across } })
        if (stiffness < Mounting::rigid)
          r += line((gear + name).c_str(), stiffness / units::newton_metre * 1e-3, "N m/mrad");
      return r;
    }

    std::string mounting_lines(const ParallelAxisCase &input)
    {
      const Misalignment &tilt = input.deviations.misalignment;
      const double width = input.pair.common_face_width;
      return "Mounting\n" + line("misalignment in the plane of action", 1e3 * tilt.in_plane, "mrad") +
             line("... over the common face width", tilt.in_plane * width / units::micrometre, "um") +
             line("misalignment across the plane of action", 1e3 * tilt.across, "mrad") +
             line("... over the common face width", tilt.across * width / units::micrometre, "um") +
             line("axial offset of the gear", input.pair.data.axial_offset, "mm") +
             spring_lines(input.pinion_mounting, "pinion") + spring_lines(input.gear_mounting, "gear");
    }
  } // namespace

  std::string geometry_report(const ParallelAxisCase &input)
  {
    const GearPair &p = input.pair;
    std::string r = pair_lines(p) + gear_lines(input, true) + gear_lines(input, false) + all_flanks(input) +
                    modification_table(input) + mounting_lines(input);
    if (input.cycles > 1)
      r += fmt::format("The same teeth meet again after {} mesh cycles: {} positions\n", input.cycles,
                       input.cycles * input.positions);
    const IsoStiffness iso = iso_6336_stiffness(p);
    r += fmt::format(
        "ISO 6336-1 method B (solid discs): c'_th {:.3f}, c' {:.3f}, c_gamma_alpha {:.3f} N/(mm um)\n",
        iso.theoretical, iso.single, iso.mesh);
    for (const std::string &warning : p.warnings)
      r += "warning: " + warning + "\n";
    return r + "What this cannot know: deflections, pressures, whether the elements resolve them.\n";
  }
} // namespace flank
