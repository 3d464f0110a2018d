// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_result.hpp"

namespace flank
{
  /// A mesh position and all its slices, which its torques share. LoadedPair::at() makes it; it refers to the
  /// gear pair and the deviations of that LoadedPair, which must outlive it unchanged.
  struct SlicedPosition
  {
    MeshPosition position;
    std::vector<Slice> slices;
  };

  /// A gear pair on its reduced bodies with what its flanks deviate by, ready to be loaded.
  struct LoadedPair
  {
    MeshBodies bodies;
    MeshDeviations deviations;
    bool derivatives = false; ///< exact ones of the rotation, by all parameters of the modifications
    bool keep_cells = false;  ///< of the contact, in the results
    bool subsurface_stress = false;

    /// The position of a phase (as MeshPosition's).
    SlicedPosition at(double phase) const;

    /// Torques of one band (each > 0) at one position of this mesh, in mesh cycles (in which other teeth
    /// meet). Result [cycle][torque]. A cycle's grid is sized for its greatest torque, and all torques share
    /// it for which it is fine enough; it depends on nothing in other cycles. Cycles in which every pair
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

    /// Any torques (>= 0): each band on a grid of its own, unloaded the geometric transmission error. With
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
    std::vector<PositionResult> gather_all(const SlicedPosition &sliced, int cycle, const PositionGrid &grid,
                                           const std::vector<ContactSolution> &solutions,
                                           const std::vector<Certificate> &certificates, int grids) const;
  };

  /// Torques grouped so that one grid serves each group: indices into `torques`, greatest first; zero torques
  /// left out.
  std::vector<std::vector<int>> torque_bands(const std::vector<double> &torques, int profile_cells);
} // namespace flank
