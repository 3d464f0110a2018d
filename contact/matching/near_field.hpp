// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace flank
{
  enum class Split
  {
    projected, ///< finite elements plus half-space minus what the elements make of the half-space
    classical  ///< Vijayakar's: half-space relative to a point below the surface, finite elements at that
               ///< point
  };

  /// How the classical split picks the point below the surface.
  enum class ClassicalDepth
  {
    half_element, ///< half an element, as Wagaj and Kahraman (2002)
    line_fit      ///< a straight line over 0.75 to 2 elements extrapolated to the surface
  };

  /// How the half-space near the contact joins the finite elements.
  struct NearField
  {
    Split split = Split::projected;
    ClassicalDepth depth = ClassicalDepth::half_element; ///< of the classical split

    /// Projected split: the ends of flanks are the edges of elastic wedges. False: they count as half-space,
    /// whose tractions on them the elements take off.
    bool free_ends = true;

    /// Points of the projected split's quadratures, in each direction, 4 to 8: of a patch's pressure, of the
    /// half-space's tractions on free faces, and of the intervals on which the block's answer is tabulated. 5
    /// leaves 5e-5 um in the transmission error.
    int points = 5;
  };
} // namespace flank
