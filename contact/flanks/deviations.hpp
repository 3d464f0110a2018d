// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"
#include "mesh/gear/microgeometry.hpp"

#include <compare>
#include <vector>

namespace flank
{
  /// How the value of a case's key becomes a modification's own parameter [mm, rad of roll].
  struct ParameterScale
  {
    enum class Kind
    {
      multiple,       ///< parameter = factor * key
      length_of_roll, ///< key / r_b
      diameter        ///< the roll angle where the diameter is the key
    };
    Kind kind = Kind::multiple;
    double factor = 1;
    double base_radius = 0; ///< [mm]

    double own(double key) const;   ///< the modification's parameter for a value of the key
    double slope(double key) const; ///< its derivative there
  };

  /// How a numbered parameter of the pair's modifications acts on one modification.
  struct ModificationParameter
  {
    std::shared_ptr<const FlankModification> modification;
    FlankModification::Parameter by;
    double value; ///< of the numbered parameter, in its key's unit
    ParameterScale scale;
  };

  /// How the loaded flanks of one gear differ from ideal ones.
  struct FlankDeviations
  {
    FlankModifications modifications; ///< the same on every tooth

    /// [number of a parameter, the same for both gears][modification of this gear that it acts on]
    std::vector<std::vector<ModificationParameter>> parameters;

    /// The same with other values of the numbered parameters, one each, in their keys' units.
    FlankDeviations with(const std::vector<double> &values) const;

    /// Errors of single teeth, in the order in which they come into mesh from tooth 0 on (which meshes at the
    /// pitch point at phase 0): how far each flank stands back, normal to the flank [mm]. Empty: none.
    std::vector<double> index_errors;

    /// Runout F_r, twice the eccentricity [mm], and the rotation since phase 0 at which the flanks stand back
    /// most [rad].
    double runout = 0, runout_angle = 0;

    /// Whether one tooth stands back otherwise than another: then no mesh cycle is like the one before.
    bool differ_by_tooth() const { return !index_errors.empty() || runout != 0; }
  };

  /// Small rotation of the pinion's axis against the gear's about the pitch point at z = 0. [rad], user's z:
  /// positive in_plane: the gap opens towards +z. across: at right angles to the plane of action, towards the
  /// gear's axis at +z (which changes gaps outside the plane of action only).
  struct Misalignment
  {
    double in_plane = 0, across = 0;
  };

  /// How far a flank of the pinion and one of the gear stand back, normal to them on the path of action. [mm]
  /// Each does so by a rotation about its gear's axis: elsewhere by as much as its lever is longer or
  /// shorter.
  struct StandBack
  {
    double pinion = 0, gear = 0;

    double sum() const { return pinion + gear; }
    auto operator<=>(const StandBack &) const = default;
  };

  /// Everything that changes gaps and nothing else: no compliance depends on it.
  struct MeshDeviations
  {
    FlankDeviations pinion, gear;
    Misalignment misalignment;

    /// Parameters of the modifications by which gaps can be differentiated.
    std::size_t n_parameters() const { return pinion.parameters.size(); }

    /// The values of these parameters, in the units of their keys.
    std::vector<double> values() const;

    /// The same flanks with other values of all these parameters: what a case with these values under its
    /// keys has, to the last bit.
    MeshDeviations with(const std::vector<double> &values) const;

    /// How far the flanks of tooth pair k stand back as a whole (index errors and runout), normal to the
    /// flank on the path of action, `cycle` mesh cycles after the first. [mm]
    StandBack stand_back(const GearPair &pair, int k, int cycle, double phase) const;
  };
} // namespace flank
