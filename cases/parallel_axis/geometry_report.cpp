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
      const int   columns = static_cast<int>(map.z.size()), rows = static_cast<int>(map.roll.size());
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
  } // namespace

  std::string geometry_report(const ParallelAxisCase &input)
  {
    using units::degree;
    const GearPair &p = input.pair;
    std::string     r;
    const auto      line = [&](const char *name, const double value, const char *unit) {
      r += fmt::format("  {:<44}{:>14.6f} {}\n", name, value, unit);
    };
    r += "Pair\n";
    line("centre distance", p.data.centre_distance, "mm");
    line("normal module", p.normal_module, "mm");
    line("transverse module", p.data.transverse_module, "mm");
    line("transverse pressure angle", p.data.transverse_pressure_angle / degree, "deg");
    line("transverse working pressure angle", p.working_pressure_angle / degree, "deg");
    line("helix angle", p.data.helix_angle / degree, "deg");
    line("base helix angle", p.base_helix_angle / degree, "deg");
    line("transverse base pitch", p.transverse_base_pitch, "mm");
    line("length of action", p.length_of_action, "mm");
    line("transverse contact ratio", p.transverse_contact_ratio, "");
    line("overlap ratio", p.overlap_ratio, "");
    line("total contact ratio", p.total_contact_ratio(), "");
    line("backlash at the pitch circles", p.backlash, "mm");
    const auto gear = [&](const Gear &g, const RollAngles &roll, const double clearance,
                          const SectorResolution &mesh, const bool right) {
      r += fmt::format("{} ({} teeth, {})\n", g.name, g.teeth,
                       p.data.helix_angle == 0 ? "spur"
                       : right                 ? "right hand"
                                               : "left hand");
      line("reference diameter", 2 * g.reference_radius, "mm");
      line("base radius", g.base_radius, "mm");
      line("tip diameter", 2 * g.tip_radius, "mm");
      line("form diameter (end of fillet)", 2 * g.form_radius, "mm");
      line("root diameter", 2 * g.root_radius, "mm");
      line("bore diameter, clamped", 2 * g.bore_radius, "mm");
      line("tooth thickness at the reference circle", g.tooth_thickness, "mm");
      line("profile shift coefficient", g.profile_shift, "");
      line("tooth thickness at the tip", g.tip_thickness, "mm");
      line("tip clearance", clearance, "mm");
      line("roll angle: form circle", g.form_roll / degree, "deg");
      line("roll angle: start of active profile", roll.start_of_active_profile / degree, "deg");
      line("roll angle: LPSTC", roll.lowest_single_contact / degree, "deg");
      line("roll angle: pitch point", roll.pitch_point / degree, "deg");
      line("roll angle: HPSTC", roll.highest_single_contact / degree, "deg");
      line("roll angle: end of the involute at the tip", roll.tip / degree, "deg");
      if (g.tip_chamfer > 0 || g.tip_rounding > 0)
        {
          line(g.tip_chamfer > 0 ? "tip chamfer, radial height" : "tip rounding, radius",
               std::max(g.tip_chamfer, g.tip_rounding), "mm");
          line("usable tip diameter", 2 * g.usable_tip_radius(), "mm");
        }
      r += fmt::format("  body: {}\n  elements of degree {}: {} along the involute, {} across the tooth, {} "
                       "along the face, {} to the bore\n",
                       input.body.describe(), mesh.degree, mesh.flank_rows, mesh.tooth_columns,
                       mesh.face_layers, mesh.rim_layers);
    };
    const bool right = p.data.pinion_hand == Hand::right;
    gear(p.pinion, p.pinion_roll, p.pinion_tip_clearance, input.pinion_mesh, right);
    gear(p.gear, p.gear_roll, p.gear_tip_clearance, input.gear_mesh, !right);
    r += "Flanks (material removed normal to the flank; left and right as seen from +z with the tooth "
         "pointing up)\n";
    const bool left_loaded = p.data.counter_clockwise_drive;
    for (const bool left : { left_loaded, !left_loaded })
      for (const bool of_pinion : { true, false })
        {
          const MeshDeviations  &side   = left == left_loaded ? input.deviations : input.coast;
          const FlankDeviations &flanks = of_pinion ? side.pinion : side.gear;
          const Gear            &g      = of_pinion ? p.pinion : p.gear;
          r += fmt::format("  {}, {} flank ({})\n", g.name, left ? "left" : "right",
                           left == left_loaded ? "loaded" : "not loaded");
          for (const auto &modification : flanks.modifications)
            r += "    " + modification->describe(g.base_radius) + "\n";
          if (!flanks.index_errors.empty())
            r += fmt::format(
                "    index errors of {} teeth, {:.3f} to {:.3f} um\n", flanks.index_errors.size(),
                *std::min_element(flanks.index_errors.begin(), flanks.index_errors.end()) / units::micrometre,
                *std::max_element(flanks.index_errors.begin(), flanks.index_errors.end()) /
                    units::micrometre);
          if (flanks.runout > 0)
            r += fmt::format("    runout {:.3f} um, flanks stand back most at {:.3f} deg\n",
                             flanks.runout / units::micrometre, flanks.runout_angle / degree);
          if (flanks.modifications.empty() && flanks.index_errors.empty() && flanks.runout == 0)
            r += "    as the involute\n";
        }
    r += modification_table(input);
    r += "Mounting\n";
    line("misalignment in the plane of action", 1e3 * input.deviations.misalignment.in_plane, "mrad");
    line("... over the common face width",
         input.deviations.misalignment.in_plane * p.common_face_width / units::micrometre, "um");
    line("misalignment across the plane of action", 1e3 * input.deviations.misalignment.across, "mrad");
    line("... over the common face width",
         input.deviations.misalignment.across * p.common_face_width / units::micrometre, "um");
    line("axial offset of the gear", p.data.axial_offset, "mm");
    for (const bool of_pinion : { true, false })
      {
        const Mounting &m      = of_pinion ? input.pinion_mounting : input.gear_mounting;
        const auto      spring = [&](const char *name, const double stiffness) {
          if (stiffness < Mounting::rigid)
            line(name, stiffness / units::newton_metre * 1e-3, "N m/mrad");
        };
        spring(of_pinion ? "pinion: torsion" : "gear: torsion", m.torsion);
        spring(of_pinion ? "pinion: tilt in the plane of action" : "gear: tilt in the plane of action",
               m.tilt_in_plane);
        spring(of_pinion ? "pinion: tilt across the plane of action"
                         : "gear: tilt across the plane of action",
               m.tilt_across);
      }
    if (input.cycles > 1)
      r += fmt::format("The same teeth meet again after {} mesh cycles: {} positions\n", input.cycles,
                       input.cycles * input.positions);
    const IsoStiffness iso = iso_6336_stiffness(p);
    r += fmt::format(
        "ISO 6336-1 method B (solid discs): c'_th {:.3f}, c' {:.3f}, c_gamma_alpha {:.3f} N/(mm um)\n",
        iso.theoretical, iso.single, iso.mesh);
    for (const std::string &warning : p.warnings)
      r += "warning: " + warning + "\n";
    r += "What this cannot know: deflections, pressures, whether the elements resolve them.\n";
    return r;
  }
} // namespace flank
