// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_result.hpp"

#include <optional>

namespace flank
{
  /// A mesh position and all its slices, which its torques share. LoadedPair::at() makes it; it refers to the
  /// gear pair and the deviations of that LoadedPair, which must outlive it unchanged.
  struct SlicedPosition
  {
    MeshPosition position;
    std::vector<Slice> slices;
    int undivided; ///< how many there would be if none were halved
    double height; ///< that they would have then [mm]

    SlicesInReach in_reach(const double reach) const
    {
      return { .all = slices, .undivided = undivided, .height = height, .reach = reach };
    }
  };

  /// A gear pair on its reduced bodies with what its flanks deviate by, ready to be loaded: the one evaluator
  /// of a pair. Runs, studies, error estimates and tests all solve their mesh positions by it.
  struct LoadedPair
  {
    MeshBodies bodies;
    MeshDeviations deviations;
    bool derivatives = false; ///< exact ones of the rotation, by all parameters of the modifications
    bool keep_cells = false;  ///< of the contact, in the results
    bool subsurface_stress = false;
    bool conditioning = false; ///< of the loaded cells' compliance, in the first mesh cycle

    /// The same pair with other values of all parameters of its modifications, in their keys' units (as
    /// MeshDeviations::with()). A compliance of its bodies serves both.
    LoadedPair with(const std::vector<double> &values) const;

    /// The position of a phase (as MeshPosition's).
    SlicedPosition at(double phase) const;

    /// A fresh compliance for one position of these bodies, nothing in it yet.
    PositionCompliance compliance() const;

    /// Torques (each > 0) at one position of this mesh, in mesh cycles (in which other teeth meet). Result
    /// [cycle][torque]. A torque's grid is sized for its octave and for what it finds on it; it depends on
    /// no other torque and on no other cycle. Cycles in which every pair
    /// stands back as in an earlier one are not solved again. Throws ComputationError if a solution or the
    /// grid under it fails its certificate. `compliance` is that of this position of these bodies; calls for
    /// other torques, cycles or deviations can share it.
    std::vector<std::vector<PositionResult>> solve(const SlicedPosition &sliced,
                                                   const std::vector<double> &torques,
                                                   const std::vector<int> &cycles,
                                                   PositionCompliance &compliance) const;

    /// The same at a phase, with a compliance of its own.
    std::vector<std::vector<PositionResult>> solve(double phase, const std::vector<double> &torques,
                                                   const std::vector<int> &cycles) const;

    /// Any torques (>= 0), unloaded the geometric transmission error. With
    /// other deviations of the bodies' pair (MeshDeviations::with) this is what they do to the transmission
    /// error, with derivatives by all of their parameters; the compliance serves them all.
    /// A torque without a solution says why and takes nothing from the others.
    /// Result [cycle][torque].
    std::vector<std::vector<PositionResult>> solve_all(const SlicedPosition &sliced,
                                                       const std::vector<double> &torques,
                                                       const std::vector<int> &cycles,
                                                       PositionCompliance &compliance) const;

    /// The first mesh cycle alone.
    std::vector<PositionResult> solve(double phase, const std::vector<double> &torques) const;

    /// Unloaded: the geometric transmission error of the true surfaces.
    PositionResult unloaded(double phase, int cycle = 0) const;

    std::size_t n_parameters() const { return derivatives ? deviations.n_parameters() : 0; }

  private:
    std::vector<std::vector<PositionResult>> solve_what_can_be(const SlicedPosition &sliced,
                                                               const std::vector<double> &torques,
                                                               const std::vector<int> &cycles,
                                                               PositionCompliance &compliance) const;
    std::vector<PositionResult> solve_cycle(const SlicedPosition &sliced, const std::vector<double> &torques,
                                            int cycle, PositionCompliance &compliance) const;

    /// Torques of one octave on the grid that is sized for it; nothing for those that it does not fit.
    std::vector<std::optional<PositionResult>> solve_together(const SlicedPosition &sliced,
                                                              const std::vector<double> &torques, int cycle,
                                                              PositionCompliance &compliance) const;

    /// One torque on the grid of its octave, which is fitted to it.
    PositionResult solve_alone(const SlicedPosition &sliced, double torque, int cycle,
                               PositionCompliance &compliance) const;
    std::vector<PositionResult> gather_all(const SlicedPosition &sliced, int cycle, const PositionGrid &grid,
                                           const std::vector<ContactSolution> &solutions,
                                           const std::vector<Certificate> &certificates, int grids) const;
  };

  /// Torques of an octave each, which share a grid where it fits them: indices into `torques`, greatest
  /// first; zero torques left out. Octaves are those of a unit that the pair has, so that a torque's grid
  /// depends on no other torque, and pairs of another size or stiffness have the same grids.
  std::vector<std::vector<int>> torque_bands(const GearPair &pair, const std::vector<double> &torques);

  /// The torques that a band names, in its order.
  std::vector<double> torques_of_band(const std::vector<double> &torques, const std::vector<int> &band);
} // namespace flank
