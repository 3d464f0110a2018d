// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/coast_flanks.hpp"
#include "contact/loaded/fitted_grids.hpp"
#include "contact/loaded/position_result.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace flank
{
  /// Numbers that are wanted of every solution, of its cells, the forces on them [N] and their
  /// pressures, with greatest ones of the line contacts under them (LineContacts) [MPa].
  using SolutionMeasure =
      std::function<std::vector<double>(const GearPair &, const std::vector<ContactCell> &,
                                        const Eigen::VectorXd &force, const Eigen::VectorXd &pressure)>;

  /// A gear pair on its reduced bodies with what its flanks deviate by, ready to be loaded: the one evaluator
  /// of a pair. Runs, studies, error estimates and tests all solve their mesh positions by it.
  struct LoadedPair
  {
    MeshBodies bodies;
    MeshDeviations deviations;
    /// Where it is given, a torque fails whose forces tilt the axes on their mountings so far that these
    /// flanks touch too.
    std::shared_ptr<const CoastFlanks> coast = nullptr;
    bool derivatives = false; ///< whether results have exact ones of the rotation by all parameters
    bool keep_cells = false;  ///< whether results keep the contact's cells, in the first mesh cycle
    std::map<std::string, SolutionMeasure> measures = {}; ///< by name; PositionResult::measured has them
    bool conditioning = false; ///< whether results have the condition of the loaded cells' compliance, in the
                               ///< first mesh cycle

    /// The same pair with other values of all parameters of its modifications, in their keys' units (as
    /// MeshDeviations::with()). A compliance of its bodies serves both.
    LoadedPair with(const std::vector<double> &values) const;

    /// The position of a phase (as MeshPosition's).
    SlicedPosition at(double phase) const;

    /// A fresh compliance for one position of these bodies, nothing in it yet.
    PositionCompliance compliance() const;

    /// Solves for torques (each > 0) [N mm] at one position of this mesh in some mesh cycles (in each of
    /// which other teeth meet). Result [cycle][torque]. A torque's grid is sized for its octave and for what
    /// it finds on it; it depends on no other torque and on no other cycle. Cycles in which every pair stands
    /// back as in an earlier one are not solved again. Throws ComputationError if a solution or the grid
    /// under it fails its certificate. `compliance` is that of this position of these bodies; calls for other
    /// torques, cycles or deviations can share it.
    std::vector<std::vector<PositionResult>> solve(const SlicedPosition &sliced,
                                                   const std::vector<double> &torques,
                                                   const std::vector<int> &cycles,
                                                   PositionCompliance &compliance) const;

    /// The same at a phase, with a compliance of its own.
    std::vector<std::vector<PositionResult>> solve(double phase, const std::vector<double> &torques,
                                                   const std::vector<int> &cycles) const;

    /// Solves for any torques (>= 0) [N mm]; of an unloaded one the result is the geometric transmission
    /// error. With other deviations of the bodies' pair (MeshDeviations::with) this is what they do to the
    /// transmission error, with derivatives by all of their parameters; the compliance serves them all. A
    /// torque without a solution says why and takes nothing from the others. Result [cycle][torque].
    std::vector<std::vector<PositionResult>> solve_all(const SlicedPosition &sliced,
                                                       const std::vector<double> &torques,
                                                       const std::vector<int> &cycles,
                                                       PositionCompliance &compliance) const;

    /// The same in the first mesh cycle alone.
    std::vector<PositionResult> solve(double phase, const std::vector<double> &torques) const;

    /// The unloaded pair: the geometric transmission error of the true surfaces.
    PositionResult unloaded(double phase, int cycle = 0) const;

    std::size_t n_parameters() const { return derivatives ? deviations.n_parameters() : 0; }

  private:
    std::vector<std::vector<PositionResult>> solve_what_can_be(const SlicedPosition &sliced,
                                                               const std::vector<double> &torques,
                                                               const std::vector<int> &cycles,
                                                               PositionCompliance &compliance) const;
    std::vector<PositionResult> solve_cycle(const SlicedPosition &sliced, const std::vector<double> &torques,
                                            int cycle, PositionCompliance &compliance) const;
    void require_free_coast_flanks(const PositionResult &result) const;
    std::vector<PositionResult> gather(const MeshPosition &position, int cycle,
                                       const FittedGrid &fitted) const;
  };
} // namespace flank
