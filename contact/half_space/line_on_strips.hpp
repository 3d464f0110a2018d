// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <vector>

namespace flank::half_space
{
  /// A strip of uniform pressure along a line contact.
  struct LoadedStrip
  {
    double place, half_width; ///< across the line [mm]
    double load_per_length;   ///< > 0 [N/mm]
  };

  /// What strips make of a line contact, beside the contact itself.
  struct LineOnStrips
  {
    double excess_approach; ///< how much further (negative: less far) than the bodies come together on
                            ///< strips, times the certainty [mm]
    std::vector<double> excess_by_load; ///< its derivatives by the strips' loads [mm mm/N]
    double max_pressure;                ///< of the contact, not of the strips [MPa]
    double certainty;                   ///< 1: strips under a Hertzian contact; towards 0: ever less like one
  };

  /// The line contact whose discrete solution these loaded strips are: in it, what strips deflect by
  /// themselves is a constant less the gap of both surfaces as all else has shifted and bent it. Where that
  /// gap is a parabola (no kink or edge within the contact), approach and pressure are Hertz's, closed form.
  /// Nothing: it is none, or the contact ends elsewhere than the strips. `effective_modulus` E* [MPa].
  /// Source: Johnson (1985), sections 2.5 and 4.2(c).
  std::optional<LineOnStrips> line_on_strips(const std::vector<LoadedStrip> &strips,
                                             double effective_modulus);
} // namespace flank::half_space
