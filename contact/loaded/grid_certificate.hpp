// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_grid.hpp"

namespace flank
{
  /// Whether the cells under a contact solution cover and resolve the contact: what a certificate of the
  /// solution alone cannot see, because it knows no other cells. Judged from the slices of the whole position
  /// and from the cells and forces as they are, by code that shares nothing with the grid that placed them.
  struct GridCertificate
  {
    double uncovered = 0; ///< greatest approach beyond first touch of a slice that has no cells, or none that
                          ///< carries and none where the surfaces touch first [mm]
    double open = 0; ///< greatest force on a cell where a window ends in the middle of the flanks, over the
                     ///< greatest force [-]
    double unresolved = 0; ///< share of the load on slices inside the flanks that have fewer loaded cells
                           ///< across than `fewest` [-]

    static constexpr int fewest = 3;                ///< loaded cells across a slice
    static constexpr double most_unresolved = 0.05; ///< of the load

    bool holds() const
    {
      return uncovered <= 0 && open <= 0 && unresolved <= most_unresolved;
    }                             ///< false for NaN
    std::string describe() const; ///< what does not hold, with its numbers and what to do
  };

  /// `slices`: all of the position, taken by the grid or not; `cells` and `force` [N] of the solution, theta
  /// [rad], in a mesh cycle.
  GridCertificate certify_grid(const MeshBodies &bodies, const MeshPosition &position, int cycle,
                               const std::vector<Slice> &slices, const std::vector<ContactCell> &cells,
                               const Eigen::VectorXd &force, double theta);
} // namespace flank
