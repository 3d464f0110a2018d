// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_grid.hpp"
#include "contact/solve/certificate.hpp"

#include <array>
#include <cmath>
#include <functional>

namespace flank
{
  /// A mesh position and all its slices, which its torques share. LoadedPair::at() makes it; it refers to the
  /// gear pair and the deviations of that LoadedPair, which must outlive it unchanged.
  struct SlicedPosition
  {
    MeshPosition position;
    std::vector<Slice> slices;
    int undivided; ///< how many slices there would be if none were halved
    double height; ///< of each slice if none were halved [mm]

    SlicesInReach in_reach(const double reach) const
    {
      return { .all = slices, .undivided = undivided, .height = height, .reach = reach };
    }
  };

  /// Torques of an octave each: indices into `torques`, greatest first; zero torques left out. Octaves begin
  /// at powers of two of a torque that follows from the pair's size and stiffness, so that a torque's grid
  /// depends on no other torque, and pairs of another size or stiffness have the same grids.
  std::vector<std::vector<int>> torque_bands(const GearPair &pair, const std::vector<double> &torques);

  /// The torques that a band names, in its order.
  std::vector<double> torques_of_band(const std::vector<double> &torques, const std::vector<int> &band);

  /// What the first grid of a torque takes of a position.
  struct FirstGrid
  {
    int slices = 0;
    std::array<double, 2> to_ends{ HUGE_VAL, HUGE_VAL }; ///< from its outermost slices to both ends of the
                                                         ///< common face width, that at low z first [mm]
  };

  /// The first grids of torques [N mm] at a phase of the first mesh cycle; a search for the one that fits may
  /// take other slices. It needs no compliance: what a position will cost follows from it.
  std::vector<FirstGrid> first_grids(const GearPair &pair, const MeshDeviations &deviations,
                                     int per_face_width, const std::vector<double> &torques, double phase);

  /// A grid and the torques that it fits, with their solutions, whose certificates hold.
  struct FittedGrid
  {
    const PositionGrid &grid;
    std::vector<std::size_t> torques; ///< places among those that were asked for
    std::vector<ContactSolution> solutions;
    std::vector<Certificate> certificates;
  };

  /// Solves torques [N mm] of one octave, greatest first, at a position in a mesh cycle. All begin on the
  /// grid that is sized for the octave; a torque that it does not fit goes on to another one, which its own
  /// solution asks for, until one fits: so its grid depends on no other torque. Those that go on to the same
  /// windows share their grid. `found` is called with every grid that fits some of them; each torque is
  /// found once. Throws ComputationError if a solution or the grid under it fails its certificate, or is not
  /// one of linear elasticity.
  void solve_on_fitted_grids(const MeshBodies &bodies, const SlicedPosition &sliced,
                             const std::vector<double> &torques, int cycle, PositionCompliance &compliance,
                             const std::function<void(const FittedGrid &)> &found);
} // namespace flank
