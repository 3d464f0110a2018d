// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/input/input.hpp"

#include "cases/parallel_axis/input/flank_input.hpp"
#include "cases/parallel_axis/pair/accuracy_level.hpp"
#include "contact/flanks/coast_flanks.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace flank
{
  namespace
  {
    constexpr double missing = std::numeric_limits<double>::quiet_NaN();

    GearData gear_data(const CaseFile &file, const std::string &name)
    {
      const auto number = [&](const char *key) { return file.number(name + "." + key); };
      const auto half = [&](const char *key) {
        const auto value = file.optional_number(name + "." + key);
        return value ? *value / 2 : missing;
      };
      GearData gear;
      gear.name = name;
      gear.teeth = file.integer(name + ".teeth");
      gear.face_width = number("face_width_mm");
      gear.tip_radius = half("tip_diameter_mm");
      gear.root_radius = half("root_diameter_mm");
      gear.tooth_thickness = file.optional_number(name + ".tooth_thickness_mm").value_or(missing);
      gear.profile_shift = file.optional_number(name + ".profile_shift").value_or(0);
      if (file.has(name + ".tooth_thickness_mm") && file.has(name + ".profile_shift"))
        throw InputError(file.place(name + ".profile_shift") +
                         "contradicts tooth_thickness_mm, which already fixes it; give one of the two");
      gear.bore_radius = half("bore_diameter_mm");
      gear.tip_chamfer = number("tip_edge.chamfer_mm");
      gear.tip_rounding = number("tip_edge.rounding_radius_mm");
      gear.fillet_radius = number("fillet_radius_mm");
      gear.youngs_modulus = number("youngs_modulus_GPa") * units::gigapascal;
      gear.poissons_ratio = number("poissons_ratio");
      return gear;
    }

    /// The one of two keys that the case gives. Throws InputError where it gives both or none.
    std::string either(const CaseFile &file, const std::string &a, const std::string &b)
    {
      if (file.has(a) && file.has(b))
        throw InputError(file.place(b) + "contradicts " + a + ", which says the same; give one of the two");
      if (!file.has(a) && !file.has(b))
        throw InputError(fmt::format("{}: {}: missing; give it or {}", file.file(), a, b));
      return file.has(a) ? a : b;
    }

    /// An angle given as such or as a deviation over the common face width. [rad]
    double tilt(const CaseFile &file, const std::string &key, const double face_width)
    {
      const std::string um = "misalignment." + key + "_um", mrad = "misalignment." + key + "_mrad";
      if (file.has(um) && file.has(mrad))
        throw InputError(file.place(mrad) + "contradicts " + um +
                         ", which says the same; give one of the two");
      return file.has(mrad) ? file.number(mrad) * 1e-3 : file.number(um) * units::micrometre / face_width;
    }

    Mounting mounting(const CaseFile &file, const std::string &gear)
    {
      Mounting result;
      const auto spring = [&](const char *key, double &stiffness) {
        if (const auto value = file.optional_number("mounting." + gear + "_" + key + "_Nm_per_mrad"))
          stiffness = *value * units::newton_metre * 1e3;
      };
      spring("torsion", result.torsion);
      spring("tilt_in_plane", result.tilt_in_plane);
      spring("tilt_across_plane", result.tilt_across);
      return result;
    }

    BodyModel body_model(const CaseFile &file, const PairData &data)
    {
      using Reduction = BodyModel::Reduction;
      BodyModel model;
      model.kind = file.text("body.model") == "ring" ? BodyModel::Kind::ring : BodyModel::Kind::segment;
      if (model.kind == BodyModel::Kind::ring)
        for (const char *key : { "body.segment_teeth", "body.cut_faces" })
          if (file.has(key))
            throw InputError(file.place(key) +
                             "belongs to body.model = \"segment\"; the ring has no cut faces");
      model.segment_teeth = file.integer("body.segment_teeth");
      if (const int most = std::min(data.pinion.teeth, data.gear.teeth) - 1;
          model.kind == BodyModel::Kind::segment &&
          (model.segment_teeth % 2 == 0 || model.segment_teeth > most))
        throw InputError(file.place("body.segment_teeth") +
                         fmt::format("must be odd and at most {}: the loaded tooth in the middle", most));
      model.clamped_cuts = file.text("body.cut_faces") == "clamped";
      const std::string reduction = file.text("body.reduction");
      model.reduction = reduction == "automatic"     ? Reduction::automatic
                        : reduction == "condensed"   ? Reduction::condensed
                        : reduction == "distributed" ? Reduction::distributed
                                                     : Reduction::direct;
      if (model.reduction == Reduction::direct && file.text("contact.split") == "classical")
        throw InputError(file.place("body.reduction") +
                         "answers at the flank alone; the classical split needs responses below it");
      return model;
    }

    ContactGridSize grid_size(const CaseFile &file)
    {
      ContactGridSize grid = accuracy_level(file.text("accuracy")).grid;
      if (file.has("contact_grid.slices"))
        grid.slices = file.integer("contact_grid.slices");
      if (file.has("contact_grid.profile_cells"))
        grid.profile_cells = file.integer("contact_grid.profile_cells");
      return grid;
    }

    NearField near_field(const CaseFile &file)
    {
      NearField near;
      near.split = file.text("contact.split") == "projected" ? Split::projected : Split::classical;
      if (near.split == Split::classical)
        near.depth = file.text("contact.classical_depth") == "half_element" ? ClassicalDepth::half_element
                                                                            : ClassicalDepth::line_fit;
      else
        near.free_ends = file.text("contact.face_ends") == "free";
      near.points = accuracy_level(file.text("accuracy")).near_field_points;
      if (near.split == Split::projected && file.has("contact.near_field_points"))
        near.points = file.integer("contact.near_field_points");
      return near;
    }

    SectorResolution resolution(const CaseFile &file, const Gear &gear, const double module)
    {
      const AccuracyLevel &level = accuracy_level(file.text("accuracy"));
      SectorResolution r;
      r.flank_rows = level.flank_rows;
      r.tooth_columns = level.tooth_columns;
      r.rim_layers = level.rim_layers;
      // A small bore has a twist of its own, which more layers towards it resolve.
      const double thickness = gear.root_radius - gear.bore_radius;
      r.rim_layers +=
          std::max(0, static_cast<int>(std::lround(2 * std::log(0.9 * thickness / gear.bore_radius))));
      r.rim_layers = enough_rim_layers(gear, r);
      r.fillet_rows = level.fillet_elements;
      r.fillet_columns = level.fillet_elements;
      r.face_layers = level.face_layers(gear.face_width / module, gear.helix_angle == 0);
      if (gear.helix_angle == 0)
        r.face_layers += r.face_layers % 2; // one half of a spur body stands for both
      const auto set = [&](const char *key, int &value) {
        if (file.has(key))
          value = file.integer(key);
      };
      set("mesh.degree", r.degree);
      set("mesh.flank_rows", r.flank_rows);
      set("mesh.tooth_columns", r.tooth_columns);
      set("mesh.face_layers", r.face_layers);
      set("mesh.fillet_rows", r.fillet_rows);
      set("mesh.fillet_columns", r.fillet_columns);
      set("mesh.rim_layers", r.rim_layers);
      r.check();
      return r;
    }

    /// Numbers the parameters of both gears' modifications alike, in the order of their keys, which it
    /// returns.
    std::vector<std::string> number_parameters(FlankInput &pinion, FlankInput &gear)
    {
      std::set<std::string> keys;
      for (const FlankInput *flank : { &pinion, &gear })
        for (const auto &[key, uses] : flank->by_key)
          keys.insert(key);
      for (FlankInput *flank : { &pinion, &gear })
        for (const std::string &key : keys)
          flank->deviations.parameters.push_back(flank->by_key[key]);
      return { keys.begin(), keys.end() };
    }

    /// Where a case gives the quantities that gear_pair.hpp and tooth_section.hpp refuse.
    std::map<std::string, std::string> keys_of_quantities()
    {
      std::map<std::string, std::string> keys = { { "centre distance", "pair.centre_distance_mm" },
                                                  { "axial offset", "pair.axial_offset_mm" },
                                                  { "element degree", "mesh.degree" },
                                                  { "tooth columns", "mesh.tooth_columns" } };
      for (const std::string gear : { "pinion", "gear" })
        for (const auto &[quantity, key] : { std::pair{ "tooth thickness", "tooth_thickness_mm" },
                                             { "tip diameter", "tip_diameter_mm" },
                                             { "root diameter", "root_diameter_mm" },
                                             { "bore diameter", "bore_diameter_mm" },
                                             { "fillet radius", "fillet_radius_mm" },
                                             { "tip chamfer", "tip_edge.chamfer_mm" },
                                             { "tip rounding", "tip_edge.rounding_radius_mm" } })
          keys[gear + " " + quantity] = gear + "." + key;
      return keys;
    }

    PairData pair_data(const CaseFile &file)
    {
      using units::degree;
      PairData data;
      const double helix = file.number("pair.helix_angle_deg") * degree;
      data.helix_angle = helix;
      data.centre_distance = file.number("pair.centre_distance_mm") +
                             file.number("pair.centre_distance_error_um") * units::micrometre;
      data.axial_offset = file.number("pair.axial_offset_mm");
      const bool normal_module =
          either(file, "pair.transverse_module_mm", "pair.normal_module_mm") == "pair.normal_module_mm";
      data.transverse_module = normal_module ? file.number("pair.normal_module_mm") / std::cos(helix)
                                             : file.number("pair.transverse_module_mm");
      const bool normal_angle = either(file, "pair.transverse_pressure_angle_deg",
                                       "pair.normal_pressure_angle_deg") == "pair.normal_pressure_angle_deg";
      data.transverse_pressure_angle =
          normal_angle
              ? std::atan(std::tan(file.number("pair.normal_pressure_angle_deg") * degree) / std::cos(helix))
              : file.number("pair.transverse_pressure_angle_deg") * degree;
      data.pinion_hand = file.text("pair.pinion_hand") == "right" ? Hand::right : Hand::left;
      data.counter_clockwise_drive = file.text("load.drive_flank") == "counter_clockwise";
      data.pinion = gear_data(file, "pinion");
      data.gear = gear_data(file, "gear");
      for (const GearData &gear : { data.pinion, data.gear })
        if (const double least = 0.01 * data.transverse_module; gear.face_width < least)
          throw InputError(file.place(gear.name + ".face_width_mm") +
                           fmt::format("a disc, and no tooth: a face width is at least a hundredth of the "
                                       "transverse module, {:.4g} mm",
                                       least));
      return data;
    }

    /// The first of these keys that the case gives; empty: none.
    std::string given(const CaseFile &file, const std::vector<std::string> &keys)
    {
      const auto at = std::find_if(keys.begin(), keys.end(), [&](const auto &key) { return file.has(key); });
      return at == keys.end() ? std::string() : *at;
    }

    /// Throws where tilted axes, single teeth and runout bring the coast flanks into contact, which is not
    /// computed: they take more than the backlash.
    void require_free_coast_flanks(const CaseFile &file, const ParallelAxisCase &input)
    {
      const GearPair &pair = input.pair;
      const double allowed = backlash_to_take(pair);
      if (most_backlash_taken(pair, input.deviations).sum() <= allowed)
        return;
      const BacklashTaken taken =
          backlash_taken(pair, input.deviations, { input.coast.pinion, input.coast.gear, input.cycles });
      if (taken.sum() <= allowed)
        return;
      const double most = std::max({ taken.by_tilts, taken.by_single_teeth, taken.by_runout });
      const std::string key =
          most == taken.by_tilts
              ? given(file, { "misalignment.in_plane_um", "misalignment.in_plane_mrad",
                              "misalignment.across_plane_um", "misalignment.across_plane_mrad" })
          : most == taken.by_single_teeth
              ? given(file, { "pinion.index_errors_um", "gear.index_errors_um" })
              : given(file, { "pinion.runout.amount_um", "gear.runout.amount_um" });
      throw InputError(
          (key.empty() ? file.file() + ": " : file.place(key)) +
          fmt::format("misalignment takes {:.4g} um, single teeth {:.4g} um and runout {:.4g} um "
                      "of the backlash, together at most {:.4g} um along the normal: the other "
                      "flanks would touch, whose contact is not computed",
                      taken.by_tilts / units::micrometre, taken.by_single_teeth / units::micrometre,
                      taken.by_runout / units::micrometre, allowed / units::micrometre));
    }

    ParallelAxisCase read_whole(const CaseFile &file)
    {
      const PairData data = pair_data(file);
      ParallelAxisCase input;
      input.title = file.text("title");
      input.pair = make_gear_pair(data);
      for (const Flank flank : { Flank::left, Flank::right })
        {
          const bool loaded = (flank == Flank::left) == data.counter_clockwise_drive;
          MeshDeviations &deviations = loaded ? input.deviations : input.coast;
          FlankInput pinion = read_flank(file, input.pair, input.pair.pinion, input.pair.pinion_roll, flank),
                     gear = read_flank(file, input.pair, input.pair.gear, input.pair.gear_roll, flank);
          std::vector<std::string> keys = number_parameters(pinion, gear);
          deviations.pinion = std::move(pinion.deviations);
          deviations.gear = std::move(gear.deviations);
          if (loaded)
            input.parameters = std::move(keys);
        }
      input.deviations.misalignment = { tilt(file, "in_plane", input.pair.common_face_width),
                                        tilt(file, "across_plane", input.pair.common_face_width) };
      input.pinion_mounting = mounting(file, "pinion");
      input.gear_mounting = mounting(file, "gear");
      input.pinion_mesh = resolution(file, input.pair.pinion, data.transverse_module);
      input.gear_mesh = resolution(file, input.pair.gear, data.transverse_module);
      input.body = body_model(file, data);
      input.grid = grid_size(file);
      if (input.grid.profile_cells % 2 == 0)
        throw InputError(file.place("contact_grid.profile_cells") +
                         "must be odd, so that a cell lies on the point of closest approach");
      input.near_field = near_field(file);
      for (const double torque : file.numbers_or_zero("load.pinion_torque_Nm", 1e-9))
        input.torques.push_back(torque * units::newton_metre);
      input.positions = file.integer("mesh_cycle.positions");
      input.cycles =
          file.text("mesh_cycle.period") == "hunting" ? std::lcm(data.pinion.teeth, data.gear.teeth) : 1;
      require_free_coast_flanks(file, input);
      input.derivatives = file.text("output.derivatives") == "yes";
      input.level = file.text("accuracy");
      if (input.cycles == 1 &&
          (input.deviations.pinion.differ_by_tooth() || input.deviations.gear.differ_by_tooth()))
        input.pair.warnings.push_back("index errors and runout repeat with the revolutions, not with the "
                                      "mesh cycle: this is the first mesh cycle "
                                      "alone; mesh_cycle.period = \"hunting\" computes all of them");
      return input;
    }
  } // namespace

  ParallelAxisCase read_pair(const CaseFile &file)
  {
    return file.with_places(keys_of_quantities(), [&] { return read_whole(file); });
  }
} // namespace flank
