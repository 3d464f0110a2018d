// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/geometry_report.hpp"

#include "cases/parallel_axis/iso_6336.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

namespace flank
{
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
    const auto gear = [&](const Gear &g, const RollAngles &roll, const double clearance, const FlankModifications &modifications,
                          const SectorResolution &mesh, const bool right) {
      r += fmt::format("{} ({} teeth, {})\n", g.name, g.teeth, p.data.helix_angle == 0 ? "spur" : right ? "right hand" : "left hand");
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
      line("roll angle: tip", roll.tip / degree, "deg");
      for (const auto &modification : modifications)
        r += "  " + modification->describe() + "\n";
      r += fmt::format(
          "  body: ring, elements of degree {}: {} along the involute, {} across the tooth, {} along the face, {} to the bore\n",
          mesh.degree, mesh.flank_rows, mesh.tooth_columns, mesh.face_layers, mesh.rim_layers);
    };
    const bool right = p.data.pinion_hand == Hand::right;
    gear(p.pinion, p.pinion_roll, p.pinion_tip_clearance, input.pinion_modifications, input.pinion_mesh, right);
    gear(p.gear, p.gear_roll, p.gear_tip_clearance, input.gear_modifications, input.gear_mesh, !right);
    const IsoStiffness iso = iso_6336_stiffness(p);
    r += fmt::format("ISO 6336-1 method B (solid discs): c'_th {:.3f}, c' {:.3f}, c_gamma_alpha {:.3f} N/(mm um)\n", iso.theoretical,
                     iso.single, iso.mesh);
    for (const std::string &warning : p.warnings)
      r += "warning: " + warning + "\n";
    r += "What this cannot know: deflections, pressures, whether the elements resolve them.\n";
    return r;
  }
} // namespace flank
