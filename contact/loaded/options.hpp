// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <limits>

namespace flank
{
  /// Cells of the contact grid of a mesh position, as Vijayakar (1991) counts them.
  struct ContactGridSize
  {
    int slices = 41;        ///< across the common face width: 2 N + 1
    int profile_cells = 11; ///< across the profile in a slice: 2 M + 1
  };

  /// Two thirds as many cells in both directions, odd numbers. For estimates of what their size makes wrong.
  constexpr ContactGridSize coarser(const ContactGridSize &grid)
  {
    constexpr int fewest_cells = 5; // three of them between those at the border, which must stay unloaded
    return { .slices = 2 * (grid.slices / 3) + 1,
             .profile_cells = std::max(fewest_cells, 2 * (grid.profile_cells / 3) + 1) };
  }

  /// Linear springs between a gear's hub and its ground; infinite: rigid. [N mm/rad]
  struct Mounting
  {
    static constexpr double rigid = std::numeric_limits<double>::infinity();

    double torsion = rigid;       ///< about its axis
    double tilt_in_plane = rigid; ///< of its axis in the plane of action, at mid-face
    double tilt_across = rigid;   ///< of its axis at right angles to the plane of action, at mid-face
  };
} // namespace flank
