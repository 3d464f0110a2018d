// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/keys.hpp"

#include "cases/double_roller/pressure_maps.hpp"
#include "cases/double_roller/supports.hpp"
#include "cases/double_roller/tolerances.hpp"

namespace flank
{
  using namespace keys;

  /// One list, in the order in which users meet the keys: it has no parts.
  SceneKeys double_roller_keys()
  {
    const double least_length = 1e-3; // of what is made [mm]
    const double um = 1000;           // no part of this size is a tenth of a millimetre off, let alone ten
    std::vector<Key> keys = {
      integer("drive.rollers", 3, 1000, "required", "number of fixed rollers N_r; N_r - 1 sleeves"),
      number("drive.roller_circle_radius_mm", least_length, 1e4, "required",
             "radius R of the circle of the rollers' centres [mm]"),
      number("drive.roller_radius_mm", least_length, 1e4, "required", "radius R_r of the rollers [mm]"),
      number("drive.sleeve_circle_radius_mm", least_length, 1e4, "required",
             "radius R1 of the circle of the sleeves' centres on the carrier [mm]"),
      number("drive.sleeve_radius_mm", least_length, 1e4, "required", "outer radius R_s of the sleeves [mm]"),
      number("drive.eccentricity_mm", least_length, 1e3, "required", "eccentricity E of the crank [mm]"),
      number("drive.width_mm", least_length, 1e4, "required",
             "length of the contact of roller and sleeve [mm]"),
      number("drive.youngs_modulus_GPa", 1e-6, 1e4, "required",
             "Young's modulus of rollers and sleeves [GPa]"),
      number("drive.poissons_ratio", 0, 0.4999, "required", "Poisson's ratio of rollers and sleeves [-]"),
      number("drive.sleeve_youngs_modulus_GPa", 1e-6, 1e4, "as the rollers",
             "Young's modulus of the sleeves alone [GPa]"),
      number("drive.sleeve_poissons_ratio", 0, 0.4999, "as the rollers",
             "Poisson's ratio of the sleeves alone [-]"),
      text("drive.profile", "circular", "flank of the sleeves: circles, or the exactly conjugate profile",
           { "circular", "conjugate" }),
      text("drive.crown.type", "straight", "lengthwise form of the rollers",
           { "straight", "full", "partial" }),
      number("drive.crown.radius_mm", least_length, 1e7, "required with full or partial",
             "radius of the crown [mm]"),
      number("drive.crown.straight_length_mm", least_length, 1e4, "required with partial",
             "length of the straight part in the middle [mm]"),
      number("drive.uniform_clearance_um", 0, um, "0", "taken off the surface of every sleeve [um]"),
      numbers("drive.roller_radius_errors_um", -um, um, "none",
              "added to the radius of each roller, N_r numbers [um]"),
      numbers("drive.sleeve_radius_errors_um", -um, um, "none",
              "added to the radius of each sleeve, N_r - 1 numbers [um]"),
      numbers("drive.roller_radial_errors_um", -um, um, "none",
              "position of each roller, outwards, N_r numbers [um]"),
      numbers("drive.roller_tangential_errors_um", -um, um, "none",
              "position of each roller, counter-clockwise, N_r numbers [um]"),
      numbers("drive.sleeve_radial_errors_um", -um, um, "none",
              "position of each sleeve on the carrier, outwards, N_r - 1 numbers [um]"),
      numbers("drive.sleeve_tangential_errors_um", -um, um, "none",
              "position of each sleeve on the carrier, counter-clockwise, N_r - 1 numbers [um]"),
      text("model.preset", "exact",
           "exact: the geometry as it is; paper: every choice below as the double-roller actuator article "
           "makes it (bibliography in contact/bibliography.md)",
           { "exact", "paper" }),
      text("model.backlash", "exact",
           "exact: gaps on both flanks; drive_only: the coast flank carries nothing; zero: all drive pairs "
           "touch unloaded",
           { "exact", "drive_only", "zero" }),
      text("model.candidates", "all",
           "all: every pair; window: sleeves within (-g/2, pi) of the crank, each with its nearest roller",
           { "all", "window" }),
      text("model.drop_interfering", "no",
           "yes: a pair that overlaps at the nominal rotation carries nothing", { "no", "yes" }),
      text("model.geometry", "iterate",
           "iterate: gaps exact at the contact position; linear: about psi = phi/N_s",
           { "iterate", "linear" }),
      text("model.gear_ratio", "instantaneous",
           "of te.csv: by implicit differentiation, or by secant over one degree of the crank",
           { "instantaneous", "secant" }),
      text("model.roller_ends", "half_space",
           "of rollers and sleeves, which end together: the half-space goes on there, or the ends are free, "
           "as edges of quarter-spaces (extent automatic)",
           { "half_space", "free" }),
      text("model.torque_on", "output",
           "what load.output_torque_Nm acts on: the carrier, or (input) the crank", { "output", "input" }),
      numbers("load.output_torque_Nm", 0, 1e9, "required", "torques on the carrier [N m]; 0: unloaded"),
      number("mesh_cycle.crank_angles_deg.from", -3600, 3600, "0", "first crank angle [deg]"),
      number("mesh_cycle.crank_angles_deg.to", -3600, 36000, "from + 360/N_r",
             "last crank angle, whole steps from the first one [deg]"),
      number("mesh_cycle.crank_angles_deg.step", 1e-6, 360,
             "1; without to 360/N_r in equal parts of at most 1, four or more",
             "step of the crank angle [deg]"),
      integer("contact_grid.cells_across", 8, 200, "20", "cells over the contact width of one pair, even"),
      integer("contact_grid.cells_along", 4, 400, "40; paper: 60", "cells over the length of one pair, even"),
      text("contact_grid.extent", "automatic",
           "along the roller: automatic follows the contact and is finer near ends; uniform: equal cells, "
           "displacement at their centres",
           { "automatic", "uniform" }),
      number("contact_grid.half_width_mm", 0, 1e3, "follows the load",
             "half-width of a prescribed grid across the contact, the same at every load [mm]", true),
    };
    for (Key &key : tolerance_keys())
      keys.push_back(std::move(key));
    for (Key &key : support_keys())
      keys.push_back(std::move(key));
    for (Key &key : PressureMaps::keys())
      keys.push_back(std::move(key));
    return { .scene = "double_roller", .keys = std::move(keys), .copy = {}, .note = {} };
  }
} // namespace flank
